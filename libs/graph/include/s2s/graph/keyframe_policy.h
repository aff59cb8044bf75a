#pragma once

#include <optional>

#include "s2s/core/transform.h"

namespace s2s::graph {

/// When a new keyframe is due; the defaults are the paper's (section on the seabed-to-sky map).
struct KeyframePolicyOptions {
  double distance_m = 1.0;
  double rotation_rad = 0.05;
};

class KeyframePolicy {
 public:
  explicit KeyframePolicy(const KeyframePolicyOptions& options = {}) : options_(options) {}

  /// True if `T_odom_vehicle` is due as a keyframe: the first pose, and then each that moved far enough from the last
  /// keyframe, which it then becomes.
  bool accept(const core::Isometry& T_odom_vehicle);

 private:
  KeyframePolicyOptions options_;
  std::optional<core::Isometry> last_;
};

}  // namespace s2s::graph
