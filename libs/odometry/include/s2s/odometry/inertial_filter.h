#pragma once

#include "s2s/odometry/imu_buffer.h"
#include "s2s/odometry/nav_state.h"
#include "s2s/odometry/options.h"

namespace s2s::odometry {

/// Exact derivative of one step of motion: errors after = F errors before + noise of covariance Q.
struct StepModel {
  NavState state;  ///< after the step
  ErrorMatrix F, Q;
};

/// One step of strapdown navigation with midpoint attitude, its Jacobian and its noise.
///
/// A step that was not measured keeps the velocity: its specific force is taken to balance gravity, and the motion
/// options give the noise. Without any IMU no step is measured and `-gyroBias` serves as the turn rate, which makes the
/// same equations a constant-velocity model; gravity then is just the belief about where down is.
StepModel propagated(const NavState& state, const MotionStep& step, const ImuOptions& imu, const MotionOptions& motion,
                     bool hasImu);

/// Error-state Kalman filter of the IMU's motion. Poses that somebody measured enter as Gaussian knowledge of the pose
/// block; all other states follow through their correlation with it.
class InertialFilter {
 public:
  InertialFilter(const ImuOptions& imu, const MotionOptions& motion, bool hasImu)
      : imu_(imu), motion_(motion), hasImu_(hasImu) {}

  void reset(const NavState& state, const ErrorMatrix& covariance);

  const NavState& state() const { return state_; }
  const ErrorMatrix& covariance() const { return covariance_; }
  bool hasImu() const { return hasImu_; }
  /// Whether there is a belief about where up is: always with an IMU; without, if the vehicle floats.
  bool knowsUp() const { return !state_.gravity.isZero(); }

  /// Moves on by steps; the states after each step are appended to `path` if given.
  void propagate(const std::vector<MotionStep>& steps, std::vector<NavState>* path = nullptr);

  /// Covariance of (position in odom, rotation vector in imu).
  core::Matrix6 poseCovariance() const { return covariance_.topLeftCorner<6, 6>(); }

  /// Replaces the belief about the pose by `posterior` with `covariance`, as found by a registration that had this
  /// filter's own pose as prior; the rest of the state follows.
  void setPosePosterior(const core::Isometry& T_odom_imu, const core::Matrix6& covariance);

  /// How high the vehicle's origin is above its floating height, against gravity [m].
  double heightAboveFloating(const core::Isometry& T_imu_vehicle) const;

  /// Takes a measurement of how high the vehicle's origin is above its floating height, against gravity.
  /// @return the innovation over its expected standard deviation
  double measureHeave(const core::Isometry& T_imu_vehicle, double heave_m, double sigma_m);

  /// Takes a measurement of the velocity of the vehicle's origin in its own frame; axes of infinite sigma are left out.
  /// @param turnRate_radps of the IMU, in its frame, without bias
  void measureVelocity(const core::Isometry& T_imu_vehicle, const Eigen::Vector3d& turnRate_radps,
                       const Eigen::Vector3d& velocity_mps, const Eigen::Vector3d& sigma_mps);

  /// Takes the knowledge that the vehicle's z axis points up, but for a lean of this standard deviation [rad].
  void measureLean(const core::Isometry& T_imu_vehicle, double sigma_rad);

  /// Covariance of the direction of up in the IMU's frame [rad^2].
  Eigen::Matrix3d upCovariance() const { return upByError() * covariance_ * upByError().transpose(); }

  /// Adds to the floating height's variance.
  void loosenFloatingHeight(double variance_m2) { covariance_(kFloating, kFloating) += variance_m2; }

  /// Takes a pose measured by something independent of the filter.
  void measurePose(const core::Isometry& T_odom_imu, const core::Matrix6& noise);

 private:
  Eigen::Vector3d up_imu() const { return -(state_.R_odom_imu.transpose() * state_.gravity).normalized(); }
  /// Derivative of the direction of up in the IMU's frame.
  Eigen::Matrix<double, 3, kErrorSize> upByError() const;

  ImuOptions imu_;
  MotionOptions motion_;
  bool hasImu_;
  NavState state_;
  ErrorMatrix covariance_ = ErrorMatrix::Zero();
};

}  // namespace s2s::odometry
