#include "s2s/mapper/water_level.h"

#include <algorithm>

namespace s2s::mapper {

void WaterLevel::add(core::TimeNs time, const Eigen::Vector3d& waterline_odom) {
  if (!known_) {
    known_ = true;
    mean_odom_ = waterline_odom;
    last_ = time;
    return;
  }
  const double step_s = std::clamp(core::secondsBetween(last_, time), 0.0, memory_s_);
  last_ = time;
  weight_s_ = std::min(weight_s_ + step_s, memory_s_);
  if (weight_s_ > 0) mean_odom_ += (waterline_odom - mean_odom_) * step_s / weight_s_;
}

}  // namespace s2s::mapper
