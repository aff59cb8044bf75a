#include "s2s/graph/keyframe_policy.h"

namespace s2s::graph {

bool KeyframePolicy::accept(const core::Isometry& T_odom_vehicle) {
  if (last_) {
    const core::Isometry motion = last_->inverse() * T_odom_vehicle;
    if (motion.translation().norm() < options_.distance_m &&
        core::logSo3(motion.linear()).norm() < options_.rotation_rad)
      return false;
  }
  last_ = T_odom_vehicle;
  return true;
}

}  // namespace s2s::graph
