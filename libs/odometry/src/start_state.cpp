#include "start_state.h"

namespace s2s::odometry {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Standard deviations of the readings below which the vehicle counts as lying still.
constexpr double kStillGyro_radps = 0.006;
constexpr double kStillAccel_mps2 = 0.08;
/// A gyro mean above this is a turn rather than a bias.
constexpr double kMostBias_radps = 0.03;

constexpr double kPoseSigma = 1e-4;  // the first pose defines the frame [m, rad]
constexpr double kStillSpeedSigma_mps = 0.02;
constexpr double kRefinedSpeedSigma_mps = 0.2;
constexpr double kTiltAccelStill_mps2 = 0.03;  // horizontal acceleration that a mean over the window may hold
constexpr double kTiltAccelMoving_mps2 = 0.5;
constexpr double kGravitySizeSigma_mps2 = 0.02;
/// A rehearsal uses the same data as the run after it; its variances are widened by this.
constexpr double kRehearsalInflation = 4.0;

struct WindowMeans {
  Vector3d force = Vector3d::Zero();  // in the first sample's frame
  Vector3d rate = Vector3d::Zero();
  double forceSigma = 0, rateSigma = 0;
  core::Isometry T_vehicle_imu = core::Isometry::Identity();
};

WindowMeans meansOf(const ImuBuffer& imu, core::TimeNs start, core::TimeNs end) {
  WindowMeans means;
  Matrix3d R_start_imu = Matrix3d::Identity();
  Vector3d rateSquares = Vector3d::Zero(), force = Vector3d::Zero(), forceSquares = Vector3d::Zero();
  double count = 0;
  core::TimeNs last = 0;
  for (const auto& sample : imu.samples()) {
    const bool isOnly = count == 0 && &sample == &imu.samples().back();
    if ((sample.time < start || sample.time > end) && !isOnly) continue;
    if (count > 0) R_start_imu *= core::expSo3(sample.angularRate_radps * core::secondsBetween(last, sample.time));
    last = sample.time;
    means.force += R_start_imu * sample.specificForce_mps2;
    means.rate += sample.angularRate_radps;
    rateSquares += sample.angularRate_radps.cwiseAbs2();
    force += sample.specificForce_mps2;
    forceSquares += sample.specificForce_mps2.cwiseAbs2();
    means.T_vehicle_imu = sample.T_vehicle_imu;
    ++count;
  }
  means.force /= count;
  means.rate /= count;
  means.rateSigma = std::sqrt(std::max(0.0, (rateSquares / count - means.rate.cwiseAbs2()).maxCoeff()));
  means.forceSigma = std::sqrt(std::max(0.0, (forceSquares / count - (force / count).cwiseAbs2()).maxCoeff()));
  return means;
}

void setSigma(StartState& start, int at, double sigma) {
  start.covariance.diagonal().segment<3>(at).setConstant(sigma * sigma);
}

void setGravity(StartState& start, double size, double tiltAccel) {
  start.state.gravity = Vector3d(0, 0, -size);
  setSigma(start, kGravity, tiltAccel);
  start.covariance(kGravity + 2, kGravity + 2) = kGravitySizeSigma_mps2 * kGravitySizeSigma_mps2;
}

}  // namespace

Matrix3d levelRotation(const Vector3d& up_body) {
  const Vector3d z = up_body.normalized();
  // A body standing on its nose has no heading; its z axis then serves.
  const Vector3d forward = std::abs(z.x()) < 0.99 ? Vector3d(Vector3d::UnitX()) : Vector3d(Vector3d::UnitZ());
  const Vector3d x = (forward - forward.dot(z) * z).normalized();
  Matrix3d R;
  R.row(0) = x.transpose();
  R.row(1) = z.cross(x).transpose();
  R.row(2) = z.transpose();
  return R;
}

StartState inertialStart(const ImuBuffer& imu, core::TimeNs startTime, core::TimeNs end,
                         const OdometryOptions& options) {
  const WindowMeans means = meansOf(imu, startTime, end);
  StartState start;
  start.isStatic =
      means.rateSigma < kStillGyro_radps && means.forceSigma < kStillAccel_mps2 && means.rate.norm() < kMostBias_radps;
  start.state.time = startTime;
  const Matrix3d R_odom_vehicle = levelRotation(means.T_vehicle_imu.linear() * means.force);
  start.state.R_odom_imu = R_odom_vehicle * means.T_vehicle_imu.linear();
  start.state.position = R_odom_vehicle * means.T_vehicle_imu.translation();
  setSigma(start, kPosition, kPoseSigma);
  setSigma(start, kRotation, kPoseSigma);
  setSigma(start, kAccelBias, options.imu.accelBiasSigma_mps2);
  if (start.isStatic) {
    start.state.gyroBias = means.rate;
    setSigma(start, kGyroBias, 0.05 * options.imu.gyroBiasSigma_radps);
    setSigma(start, kVelocity, kStillSpeedSigma_mps);
  } else {
    setSigma(start, kGyroBias, options.imu.gyroBiasSigma_radps);
    setSigma(start, kVelocity, options.motion.initialSpeedSigma_mps);
  }
  start.covariance(kFloating, kFloating) = options.water.heaveSigma_m * options.water.heaveSigma_m;
  setGravity(start, options.imu.gravity_mps2, start.isStatic ? kTiltAccelStill_mps2 : kTiltAccelMoving_mps2);
  return start;
}

StartState lidarOnlyStart(core::TimeNs startTime, const OdometryOptions& options) {
  StartState start;
  start.state.time = startTime;
  setSigma(start, kPosition, kPoseSigma);
  setSigma(start, kRotation, kPoseSigma);
  setSigma(start, kVelocity, options.motion.initialSpeedSigma_mps);
  setSigma(start, kGyroBias, options.motion.initialTurnRateSigma_radps);
  return start;
}

StartState refinedStart(const StartState& rough, const InertialFilter& rehearsed, const ImuBuffer& imu,
                        const OdometryOptions& options) {
  StartState start = rough;
  const NavState& end = rehearsed.state();
  start.state.gyroBias = end.gyroBias;
  if (!rehearsed.hasImu()) {
    start.state.velocity = end.velocity;
    return start;
  }
  start.state.accelBias = end.accelBias;
  // The first vehicle frame, levelled anew: the correction turns the frame, not the vehicle.
  const core::Isometry T_imu_vehicle = imu.samples().front().T_vehicle_imu.inverse();
  const Matrix3d R_old_vehicle = rough.state.R_odom_imu * T_imu_vehicle.linear();
  const Matrix3d R_new_vehicle = levelRotation(R_old_vehicle.transpose() * -end.gravity);
  const Matrix3d R_new_old = R_new_vehicle * R_old_vehicle.transpose();
  start.state.R_odom_imu = R_new_old * rough.state.R_odom_imu;
  start.state.position = R_new_old * rough.state.position;
  setGravity(start, options.imu.gravity_mps2, 0);
  for (const int at : {kGyroBias, kAccelBias, kGravity}) {
    const Vector3d widened = kRehearsalInflation * rehearsed.covariance().diagonal().segment<3>(at);
    start.covariance.diagonal().segment<3>(at) = widened.cwiseMin(rough.covariance.diagonal().segment<3>(at));
  }
  if (rough.isStatic) return start;
  // The speed at the start is the rehearsal's last one less what the IMU felt since.
  InertialFilter fromRest(options.imu, options.motion, true);
  NavState rest = start.state;
  rest.velocity.setZero();
  fromRest.reset(rest, ErrorMatrix::Zero());
  fromRest.propagate(imu.steps(rest.time, end.time, options.imu.maxGap_s));
  start.state.velocity = R_new_old * end.velocity - fromRest.state().velocity;
  setSigma(start, kVelocity, kRefinedSpeedSigma_mps);
  // Where nothing in sight tells the speed in some direction, the rehearsal has not learnt it either.
  start.covariance.block<3, 3>(kVelocity, kVelocity) +=
      R_new_old * rehearsed.covariance().block<3, 3>(kVelocity, kVelocity) * R_new_old.transpose();
  return start;
}

}  // namespace s2s::odometry
