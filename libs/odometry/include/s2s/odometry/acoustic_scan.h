#pragma once

#include <Eigen/Core>
#include <vector>

#include "s2s/core/time.h"

namespace s2s::odometry {

/// Points below the water that the sonars saw at one moment.
struct AcousticScan {
  core::TimeNs time = 0;
  std::vector<Eigen::Vector3f> points_vehicle;  ///< [m], in the vehicle's frame at `time`
  std::vector<float> sigma_m;                   ///< standard deviation along the worst axis
};

}  // namespace s2s::odometry
