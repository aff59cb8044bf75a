#pragma once

#include <Eigen/Core>

#include "s2s/odometry/imu_buffer.h"
#include "s2s/odometry/nav_state.h"
#include "s2s/odometry/options.h"

namespace s2s::odometry {

/// What the IMU alone tells about a floating vessel's vertical motion over a short time: heave is a motion about a
/// fixed height, so of the double integral of the acceleration everything like a + b t + c t^2 / 2 is due to the
/// unknown height, speed and error of acceleration at the start. Least squares with weak prior knowledge of the three.
struct HeaveFit {
  double floatingHeight_m = 0;   ///< height about which the vehicle's origin heaves, in the frame of the start
  double speed_mps = 0;          ///< upward speed at the start
  double acceleration_mps2 = 0;  ///< upward acceleration that biases and gravity's size leave open
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of the three
  double heaveSigma_m = 0;                               ///< of the heave found
};

/// @param start  attitude, biases and gravity at the start; its velocity is not used
/// @param end    of the time looked at
HeaveFit fitHeave(const NavState& start, const core::Isometry& T_imu_vehicle, const ImuBuffer& imu, core::TimeNs end,
                  const OdometryOptions& options);

}  // namespace s2s::odometry
