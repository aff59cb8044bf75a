#include "s2s/odometry/inertial_filter.h"

#include <Eigen/Cholesky>

namespace s2s::odometry {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Share of the angular acceleration's density that stands for the unknown turn rate while an IMU is silent [s^0.5].
constexpr double kSilentRateShare = 0.1;

/// Clocks and mountings hardly change; these random walks keep what the model leaves out from being believed for ever.
constexpr double kTimeOffsetWalk_s_rts = 2e-5;
constexpr double kMountingWalk_rad_rts = 2e-5;

double squared(double x) { return x * x; }

/// Noise that enters during one step, white over the step.
ErrorMatrix stepNoise(const MotionStep& step, const ImuOptions& imu, const MotionOptions& motion, bool hasImu) {
  ErrorMatrix Q = ErrorMatrix::Zero();
  const double dt = step.duration_s;
  const auto set = [&](int at, double variance) { Q.diagonal().segment<3>(at).setConstant(variance); };
  const double acceleration = step.isMeasured ? imu.accelNoise_mps2_rthz : motion.acceleration_mps2_rthz;
  const double velocityVariance = squared(acceleration) * dt;
  set(kVelocity, velocityVariance);
  set(kPosition, velocityVariance * dt * dt / 3.0);
  Q.block<3, 3>(kPosition, kVelocity) = Q.block<3, 3>(kVelocity, kPosition) =
      0.5 * dt * velocityVariance * Matrix3d::Identity();
  if (hasImu) {
    const double rate =
        step.isMeasured ? imu.gyroNoise_radps_rthz : kSilentRateShare * motion.angularAcceleration_radps2_rthz;
    set(kRotation, squared(rate) * dt);
    set(kGyroBias, squared(imu.gyroBiasWalk_radps2_rthz) * dt);
    set(kAccelBias, squared(imu.accelBiasWalk_mps3_rthz) * dt);
    if (imu.estimateTimeOffset) Q(kTimeOffset, kTimeOffset) = squared(kTimeOffsetWalk_s_rts) * dt;
    if (imu.estimateMounting) set(kMounting, squared(kMountingWalk_rad_rts) * dt);
    return Q;
  }
  const double rateVariance = squared(motion.angularAcceleration_radps2_rthz) * dt;
  set(kGyroBias, rateVariance);
  set(kRotation, rateVariance * dt * dt / 3.0);
  Q.block<3, 3>(kRotation, kGyroBias) = Q.block<3, 3>(kGyroBias, kRotation) =
      -0.5 * dt * rateVariance * Matrix3d::Identity();
  return Q;
}

}  // namespace

StepModel propagated(const NavState& state, const MotionStep& step, const ImuOptions& imu, const MotionOptions& motion,
                     bool hasImu) {
  const double dt = step.duration_s;
  // Readings at the moment that the present time offset says, turned into the frame of the mounting.
  const double later_s = state.timeOffset_s - step.timeOffset_s;
  const Vector3d rateReading = state.R_imu_readings * (step.angularRate_radps + later_s * step.angularRateSlope_radps2);
  const Vector3d forceReading =
      state.R_imu_readings * (step.specificForce_mps2 + later_s * step.specificForceSlope_mps3);
  const Vector3d turn = (rateReading - state.gyroBias) * dt;
  const Matrix3d halfTurn = core::expSo3(0.5 * turn);
  const Matrix3d R_middle = state.R_odom_imu * halfTurn;
  const Vector3d force = forceReading - state.accelBias;
  const Vector3d acceleration =
      step.isMeasured ? Vector3d(R_middle * force + state.gravity) : Vector3d(Vector3d::Zero());

  StepModel out;
  out.state = state;
  out.state.time = step.end;
  out.state.position += dt * state.velocity + 0.5 * dt * dt * acceleration;
  out.state.velocity += dt * acceleration;
  out.state.R_odom_imu = state.R_odom_imu * core::expSo3(turn);

  ErrorMatrix& F = out.F;
  F.setIdentity();
  F.block<3, 3>(kRotation, kRotation) = core::expSo3(-turn);
  F.block<3, 3>(kRotation, kGyroBias) = -dt * core::rightJacobianSo3(turn);
  F.block<3, 3>(kPosition, kVelocity) = dt * Matrix3d::Identity();
  if (step.isMeasured) {
    const Matrix3d byRotation = -R_middle * core::skew(force) * halfTurn.transpose();
    const Matrix3d byGyroBias = R_middle * core::skew(force) * core::rightJacobianSo3(0.5 * turn) * (0.5 * dt);
    const auto setBlock = [&](int column, const Matrix3d& derivative) {
      F.block<3, 3>(kVelocity, column) = dt * derivative;
      F.block<3, 3>(kPosition, column) = 0.5 * dt * dt * derivative;
    };
    setBlock(kRotation, byRotation);
    setBlock(kGyroBias, byGyroBias);
    setBlock(kAccelBias, -R_middle);
    setBlock(kGravity, Matrix3d::Identity());
    F.block<3, 3>(kPosition, kVelocity) = dt * Matrix3d::Identity();
  }
  // Time offset and mounting change the readings, as the biases do with the opposite sign.
  Eigen::Matrix<double, 3, 4> rateBy, forceBy;
  rateBy << state.R_imu_readings * step.angularRateSlope_radps2, -core::skew(rateReading);
  forceBy << state.R_imu_readings * step.specificForceSlope_mps3, -core::skew(forceReading);
  F.block<9, 4>(0, kTimeOffset) = -F.block<9, 3>(0, kGyroBias) * rateBy - F.block<9, 3>(0, kAccelBias) * forceBy;
  out.Q = stepNoise(step, imu, motion, hasImu);
  return out;
}

void InertialFilter::reset(const NavState& state, const ErrorMatrix& covariance) {
  state_ = state;
  covariance_ = covariance;
}

void InertialFilter::propagate(const std::vector<MotionStep>& steps, std::vector<NavState>* path) {
  for (const auto& step : steps) {
    const StepModel model = propagated(state_, step, imu_, motion_, hasImu_);
    state_ = model.state;
    covariance_ = model.F * covariance_ * model.F.transpose() + model.Q;
    if (path) path->push_back(state_);
  }
  covariance_ = 0.5 * (covariance_ + covariance_.transpose()).eval();
}

void InertialFilter::setPosePosterior(const core::Isometry& T_odom_imu, const core::Matrix6& covariance) {
  const core::Matrix6 prior = poseCovariance();
  const Eigen::LDLT<core::Matrix6> solver(prior);
  // How the whole state follows the pose: P(:,pose) P(pose,pose)^-1.
  const Eigen::Matrix<double, kErrorSize, 6> gain = solver.solve(covariance_.topRows<6>()).transpose();
  core::Vector6 poseError;
  poseError << T_odom_imu.translation() - state_.position,
      core::logSo3(state_.R_odom_imu.transpose() * T_odom_imu.linear());
  state_ = moved(state_, gain * poseError);
  state_.position = T_odom_imu.translation();
  state_.R_odom_imu = T_odom_imu.linear();
  covariance_ -= gain * (prior - covariance) * gain.transpose();
  covariance_.topLeftCorner<6, 6>() = covariance;
  covariance_ = 0.5 * (covariance_ + covariance_.transpose()).eval();
}

double InertialFilter::heightAboveFloating(const core::Isometry& T_imu_vehicle) const {
  const Vector3d p_vehicle = state_.position + state_.R_odom_imu * T_imu_vehicle.translation();
  return -state_.gravity.normalized().dot(p_vehicle) - state_.floatingHeight;
}

double InertialFilter::measureHeave(const core::Isometry& T_imu_vehicle, double heave_m, double sigma_m) {
  const Vector3d up = -state_.gravity.normalized();
  const Vector3d lever = T_imu_vehicle.translation();
  ErrorVector h = ErrorVector::Zero();
  h.segment<3>(kPosition) = up;
  h.segment<3>(kRotation) = lever.cross(state_.R_odom_imu.transpose() * up);
  // Far from the origin a tilt of the vertical is a height, and so the water's level tells the tilt.
  const Vector3d p_vehicle = state_.position + state_.R_odom_imu * lever;
  h.segment<3>(kGravity) = (up * up.dot(p_vehicle) - p_vehicle) / state_.gravity.norm();
  h[kFloating] = -1;
  const ErrorVector Ph = covariance_ * h;
  const double innovationVariance = h.dot(Ph) + sigma_m * sigma_m;
  const double innovation = heave_m - heightAboveFloating(T_imu_vehicle);
  state_ = moved(state_, Ph * (innovation / innovationVariance));
  covariance_ -= Ph * Ph.transpose() / innovationVariance;
  return innovation / std::sqrt(innovationVariance);
}

void InertialFilter::measureVelocity(const core::Isometry& T_imu_vehicle, const Vector3d& turnRate_radps,
                                     const Vector3d& velocity_mps, const Vector3d& sigma_mps) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(sigma_mps[axis])) continue;
    const Vector3d direction_imu = T_imu_vehicle.linear().col(axis);
    const Vector3d velocity_imu = state_.R_odom_imu.transpose() * state_.velocity;
    ErrorVector h = ErrorVector::Zero();
    h.segment<3>(kVelocity) = state_.R_odom_imu * direction_imu;
    h.segment<3>(kRotation) = direction_imu.cross(velocity_imu);
    h.segment<3>(kGyroBias) = direction_imu.cross(T_imu_vehicle.translation());
    const Vector3d atOrigin = velocity_imu + turnRate_radps.cross(T_imu_vehicle.translation());
    const ErrorVector Ph = covariance_ * h;
    const double innovation = velocity_mps[axis] - direction_imu.dot(atOrigin);
    const double variance = h.dot(Ph) + sigma_mps[axis] * sigma_mps[axis];
    state_ = moved(state_, Ph * (innovation / variance));
    covariance_ -= Ph * Ph.transpose() / variance;
  }
}

void InertialFilter::measureLean(const core::Isometry& T_imu_vehicle, double sigma_rad) {
  for (int axis = 0; axis < 2; ++axis) {
    const Vector3d level_imu = T_imu_vehicle.linear().col(axis);
    const ErrorVector h = (level_imu.transpose() * upByError()).transpose();
    const ErrorVector Ph = covariance_ * h;
    const double variance = h.dot(Ph) + sigma_rad * sigma_rad;
    state_ = moved(state_, Ph * (-level_imu.dot(up_imu()) / variance));
    covariance_ -= Ph * Ph.transpose() / variance;
  }
}

Eigen::Matrix<double, 3, kErrorSize> InertialFilter::upByError() const {
  const Vector3d up = up_imu();
  Eigen::Matrix<double, 3, kErrorSize> J = Eigen::Matrix<double, 3, kErrorSize>::Zero();
  J.middleCols<3>(kRotation) = core::skew(up);
  J.middleCols<3>(kGravity) =
      -(Matrix3d::Identity() - up * up.transpose()) * state_.R_odom_imu.transpose() / state_.gravity.norm();
  return J;
}

void InertialFilter::measurePose(const core::Isometry& T_odom_imu, const core::Matrix6& noise) {
  const core::Matrix6 prior = poseCovariance();
  const core::Matrix6 gain = (prior + noise).ldlt().solve(prior).transpose();
  core::Vector6 innovation;
  innovation << T_odom_imu.translation() - state_.position,
      core::logSo3(state_.R_odom_imu.transpose() * T_odom_imu.linear());
  const core::Vector6 error = gain * innovation;
  core::Isometry T = core::Isometry::Identity();
  T.translation() = state_.position + error.head<3>();
  T.linear() = state_.R_odom_imu * core::expSo3(error.tail<3>());
  const core::Matrix6 I_K = core::Matrix6::Identity() - gain;
  setPosePosterior(T, I_K * prior * I_K.transpose() + gain * noise * gain.transpose());
}

}  // namespace s2s::odometry
