#pragma once

#include <mrpt/obs/CObservationIMU.h>

#include <Eigen/Core>
#include <optional>

#include "s2s/core/time.h"
#include "s2s/core/transform.h"

namespace s2s::odometry {

/// One reading of a 6-axis IMU, in the IMU's own frame.
struct ImuSample {
  core::TimeNs time = 0;
  Eigen::Vector3d angularRate_radps = Eigen::Vector3d::Zero();
  /// Acceleration minus gravity, as an accelerometer feels it: +9.81 upwards at rest.
  Eigen::Vector3d specificForce_mps2 = Eigen::Vector3d::Zero();
  core::Isometry T_vehicle_imu = core::Isometry::Identity();
};

/// The sample in an MRPT observation; nothing if it lacks one of the six axes.
std::optional<ImuSample> imuSampleFrom(const mrpt::obs::CObservationIMU& observation);

}  // namespace s2s::odometry
