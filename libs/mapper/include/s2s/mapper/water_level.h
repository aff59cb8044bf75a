#pragma once

#include <Eigen/Core>

#include "s2s/core/time.h"

namespace s2s::mapper {

/// Height of the water surface in the odometry's frame, from the places of a hull that floats on it.
///
/// Waves move the hull around the surface, so the height is that of a mean place: over everything at first, later over
/// the last `memory_s`, so that slow drift of the odometry, locks and tides are followed. The frame is only as level as
/// its start knew; half a degree is a metre after a hundred, so heights are taken along the up that is known by now.
class WaterLevel {
 public:
  explicit WaterLevel(double memory_s = 20.0) : memory_s_(memory_s) {}

  /// @param waterline_odom the hull's waterline at `time` [m]
  void add(core::TimeNs time, const Eigen::Vector3d& waterline_odom);

  bool known() const { return known_; }
  /// Along `up_odom` (a unit vector), above the frame's origin.
  double height_m(const Eigen::Vector3d& up_odom) const { return up_odom.dot(mean_odom_); }

 private:
  double memory_s_;
  bool known_ = false;
  core::TimeNs last_ = 0;
  Eigen::Vector3d mean_odom_ = Eigen::Vector3d::Zero();
  double weight_s_ = 0;
};

}  // namespace s2s::mapper
