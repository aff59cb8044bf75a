#pragma once

#include "s2s/core/time.h"

namespace s2s::mapper {

/// Height of the water surface in the odometry's frame, from the heights of a hull that floats on it.
///
/// Waves move the hull around the surface, so the height is a mean: over everything at first, later over the last
/// `memory_s`, so that slow drift of the odometry, locks and tides are followed.
class WaterLevel {
 public:
  explicit WaterLevel(double memory_s = 60.0) : memory_s_(memory_s) {}

  /// @param height_m height of the hull's waterline at `time`
  void add(core::TimeNs time, double height_m);

  bool known() const { return known_; }
  double height_m() const { return height_m_; }

 private:
  double memory_s_;
  bool known_ = false;
  core::TimeNs last_ = 0;
  double height_m_ = 0, weight_s_ = 0;
};

}  // namespace s2s::mapper
