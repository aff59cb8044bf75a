#include "s2s/mapper/water_level.h"

#include <algorithm>

namespace s2s::mapper {

void WaterLevel::add(core::TimeNs time, double height_m) {
  if (!known_) {
    known_ = true;
    height_m_ = height_m;
    last_ = time;
    return;
  }
  const double step_s = std::clamp(core::secondsBetween(last_, time), 0.0, memory_s_);
  last_ = time;
  weight_s_ = std::min(weight_s_ + step_s, memory_s_);
  if (weight_s_ > 0) height_m_ += (height_m - height_m_) * step_s / weight_s_;
}

}  // namespace s2s::mapper
