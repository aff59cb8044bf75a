#include "s2s/odometry/odometry_result.h"

namespace s2s::odometry {

namespace {

/// Carries a right perturbation from the start of a motion to its end: exp(d) T = T exp(Ad(T^-1) d).
core::Matrix6 adjointOfInverse(const core::Isometry& T) {
  const Eigen::Matrix3d Rt = T.linear().transpose();
  core::Matrix6 A = core::Matrix6::Zero();
  A.topLeftCorner<3, 3>() = Rt;
  A.bottomRightCorner<3, 3>() = Rt;
  A.topRightCorner<3, 3>() = -Rt * core::skew(T.translation());
  return A;
}

}  // namespace

void MotionAccumulator::add(const OdometryResult& result) {
  if (result.status == OdometryStatus::skipped) return;
  if (!hasStart_) {
    hasStart_ = true;
    T_start_ = T_last_ = result.T_odom_vehicle;
    startCovariance_ = lastCovariance_ = result.covariance_registration;
    return;
  }
  const core::Matrix6 A = adjointOfInverse(T_last_.inverse() * result.T_odom_vehicle);
  drift_ = A * drift_ * A.transpose() + result.covariance_motion;
  T_last_ = result.T_odom_vehicle;
  lastCovariance_ = result.covariance_registration;
}

MotionAccumulator::Motion MotionAccumulator::motion() const {
  Motion motion;
  motion.T_from_to = T_start_.inverse() * T_last_;
  const core::Matrix6 A = adjointOfInverse(motion.T_from_to);
  motion.covariance = A * startCovariance_ * A.transpose() + drift_ + lastCovariance_;
  return motion;
}

void MotionAccumulator::restart() {
  T_start_ = T_last_;
  startCovariance_ = lastCovariance_;
  drift_.setZero();
}

}  // namespace s2s::odometry
