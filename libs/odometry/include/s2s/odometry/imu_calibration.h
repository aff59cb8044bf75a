#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace s2s::odometry {

/// What the odometry found of the IMU's clock and mounting. A standard deviation of zero: not estimated.
struct ImuCalibration {
  double timeOffset_s = 0;  ///< time stamp of the IMU less that of the LiDAR for the same moment
  double timeOffsetSigma_s = 0;
  /// Rotation vector that takes the IMU's readings into the frame where its mounting says they are.
  Eigen::Vector3d turn_rad = Eigen::Vector3d::Zero();
  Eigen::Vector3d turnSigma_rad = Eigen::Vector3d::Zero();
};

/// One sentence for each thing that the configuration or the recording says and the data contradict, with the remedy.
std::vector<std::string> contradictions(const ImuCalibration& imu);

}  // namespace s2s::odometry
