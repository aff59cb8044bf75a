#pragma once

#include <Eigen/Core>

#include "s2s/core/time.h"
#include "s2s/core/transform.h"

namespace s2s::odometry {

/// Motion of the IMU in the odometry's frame, and what its readings are off by.
struct NavState {
  core::TimeNs time = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Matrix3d R_odom_imu = Eigen::Matrix3d::Identity();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();   ///< [m/s], in odom
  Eigen::Vector3d gyroBias = Eigen::Vector3d::Zero();   ///< [rad/s], in imu
  Eigen::Vector3d accelBias = Eigen::Vector3d::Zero();  ///< [m/s^2], in imu
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();    ///< [m/s^2], in odom; points down
  double floatingHeight = 0;  ///< [m] height in odom at which the vehicle's origin floats on calm water
  double timeOffset_s = 0;    ///< time stamp of the IMU less that of the LiDAR for the same moment
  /// Takes the IMU's readings to the frame in which its mounting says they are; that frame is "imu" above.
  Eigen::Matrix3d R_imu_readings = Eigen::Matrix3d::Identity();

  core::Isometry T_odom_imu() const {
    core::Isometry T = core::Isometry::Identity();
    T.linear() = R_odom_imu;
    T.translation() = position;
    return T;
  }
};

/// Error of a state: all parts add, but the attitude's rotation vector multiplies from the right and that of the
/// mounting from the left.
constexpr int kErrorSize = 23;
constexpr int kPosition = 0, kRotation = 3, kVelocity = 6, kGyroBias = 9, kAccelBias = 12, kGravity = 15,
              kFloating = 18, kTimeOffset = 19, kMounting = 20;
using ErrorVector = Eigen::Matrix<double, kErrorSize, 1>;
using ErrorMatrix = Eigen::Matrix<double, kErrorSize, kErrorSize>;

/// The state moved by an error, and the error that moves `from` to `to`.
NavState moved(const NavState& state, const ErrorVector& error);
ErrorVector errorBetween(const NavState& from, const NavState& to);

}  // namespace s2s::odometry
