#include "start_state.h"

#include <Eigen/Eigenvalues>

#include "s2s/odometry/heave_fit.h"

namespace s2s::odometry {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Standard deviations of the readings below which the vehicle counts as lying still.
constexpr double kStillGyro_radps = 0.006;
constexpr double kStillAccel_mps2 = 0.08;
/// A gyro mean above this is a turn rather than a bias.
constexpr double kMostBias_radps = 0.03;
/// Rest shorter than this tells nothing, and the share of a rest that is used if it ends by motion, which shows late.
constexpr double kLeastStill_s = 1.0;
constexpr double kStillShare = 0.75;
/// Squared Mahalanobis distance (3 degrees of freedom, 99.9 %) above which the scans deny that a speed is zero.
constexpr double kMostRestMisfit = 16.3;
/// A speed known worse than the first is not told by the scans; the second is that of a vessel that lies about still.
constexpr double kUntoldSpeedSigma_mps = 0.15, kRestSpeedSigma_mps = 0.2;

constexpr double kPoseSigma = 1e-4;  // the first pose defines the frame [m, rad]
constexpr double kStillSpeedSigma_mps = 0.02;
constexpr double kRefinedSpeedSigma_mps = 0.03;
constexpr double kTiltAccelStill_mps2 = 0.03;  // horizontal acceleration that a mean over the window may hold
constexpr double kTiltAccelMoving_mps2 = 0.5;
constexpr double kGravitySizeSigma_mps2 = 0.02;
/// A rehearsal uses the same data as the run after it; its variances are widened by this.
constexpr double kRehearsalInflation = 4.0;

struct WindowMeans {
  Vector3d force = Vector3d::Zero();     // in the first sample's frame
  Vector3d gyroBias = Vector3d::Zero();  // zero if the vehicle moves
  bool isStatic = false;
  core::Isometry T_vehicle_imu = core::Isometry::Identity();
};

/// Samples of the window; if there is none, the last one.
std::vector<ImuSample> samplesWithin(const ImuBuffer& imu, core::TimeNs start, core::TimeNs end) {
  std::vector<ImuSample> samples;
  for (const auto& sample : imu.samples())
    if (sample.time >= start && sample.time <= end) samples.push_back(sample);
  if (samples.empty()) samples.push_back(imu.samples().back());
  return samples;
}

/// Mean and standard deviation of readings that come one by one.
class Spread {
 public:
  void add(const Vector3d& reading) {
    ++count_;
    sum_ += reading;
    squares_ += reading.cwiseAbs2();
  }
  Vector3d mean() const { return sum_ / count_; }
  /// Of the worst axis.
  double sigma() const { return std::sqrt(std::max(0.0, (squares_ / count_ - mean().cwiseAbs2()).maxCoeff())); }

 private:
  double count_ = 0;
  Vector3d sum_ = Vector3d::Zero(), squares_ = Vector3d::Zero();
};

/// Number of the first samples during which the IMU felt no motion; 0 if that is too short to tell.
std::size_t stillCount(const std::vector<ImuSample>& samples) {
  const auto sinceFirst_s = [&](std::size_t i) { return core::secondsBetween(samples.front().time, samples[i].time); };
  const double least_s = std::min(kLeastStill_s, sinceFirst_s(samples.size() - 1));
  Spread rate, force;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    rate.add(samples[i].angularRate_radps);
    force.add(samples[i].specificForce_mps2);
    if (sinceFirst_s(i) < least_s) continue;
    const bool isStill =
        rate.sigma() < kStillGyro_radps && force.sigma() < kStillAccel_mps2 && rate.mean().norm() < kMostBias_radps;
    if (isStill) continue;
    const auto used = static_cast<std::size_t>(kStillShare * static_cast<double>(i));
    return sinceFirst_s(used) < least_s ? 0 : used;
  }
  return samples.size();
}

/// Of the rest that the window begins with; if there is none, of the whole window.
WindowMeans meansOf(const ImuBuffer& imu, core::TimeNs start, core::TimeNs end) {
  auto samples = samplesWithin(imu, start, end);
  WindowMeans means;
  const std::size_t still = stillCount(samples);
  means.isStatic = still > 0;
  if (means.isStatic) {
    samples.resize(still);
    Spread rate;
    for (const auto& sample : samples) rate.add(sample.angularRate_radps);
    means.gyroBias = rate.mean();
  }
  means.T_vehicle_imu = samples.back().T_vehicle_imu;
  Matrix3d R_start_imu = Matrix3d::Identity();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i > 0)
      R_start_imu *= core::expSo3((samples[i].angularRate_radps - means.gyroBias) *
                                  core::secondsBetween(samples[i - 1].time, samples[i].time));
    means.force += R_start_imu * samples[i].specificForce_mps2 / static_cast<double>(samples.size());
  }
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

/// Vertical speed, floating height and vertical error of acceleration as the heave tells them.
void useHeave(const core::Isometry& T_imu_vehicle, const ImuBuffer& imu, core::TimeNs end,
              const OdometryOptions& options, StartState& start) {
  if (!options.water.heavePrior) return;
  const bool isCovered = core::secondsBetween(start.state.time, imu.samples().front().time) <= options.imu.maxGap_s;
  if (!isCovered) return;
  const HeaveFit fit = fitHeave(start.state, T_imu_vehicle, imu, std::min(end, imu.lastTime()), options);
  const Vector3d up = -start.state.gravity.normalized();
  start.state.velocity += (fit.speed_mps - up.dot(start.state.velocity)) * up;
  start.state.floatingHeight = fit.floatingHeight_m;
  // What the accelerometer reads too low along the vertical is taken for its bias.
  const Vector3d up_imu = start.state.R_odom_imu.transpose() * up;
  start.state.accelBias -= fit.acceleration_mps2 * up_imu;
  // The variance along an axis becomes the given one if that is less, as by a measurement along it.
  const auto setAlong = [&](int at, const Vector3d& axis, double variance) {
    auto block = start.covariance.block<3, 3>(at, at);
    const Vector3d column = block * axis;
    const double before = axis.dot(column);
    if (variance < before) block -= (1 - variance / before) / before * column * column.transpose();
  };
  setAlong(kVelocity, up, fit.covariance(1, 1));
  setAlong(kAccelBias, up_imu, fit.covariance(2, 2));
  start.covariance(kFloating, kFloating) = fit.covariance(0, 0);
  start.heaveSigma_m = fit.heaveSigma_m;
}

bool leavesSpeedOpen(const StartState& start) {
  const Matrix3d covariance = start.covariance.block<3, 3>(kVelocity, kVelocity);
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
  return solver.eigenvalues()[2] > kUntoldSpeedSigma_mps * kUntoldSpeedSigma_mps;
}

/// A vessel is taken to lie about still when its record begins, in those directions in which no scan tells its speed.
void assumeRest(StartState& start) {
  auto covariance = start.covariance.block<3, 3>(kVelocity, kVelocity);
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(Matrix3d{covariance});
  for (int i = 0; i < 3; ++i) {
    const double variance = solver.eigenvalues()[i], rest = kRestSpeedSigma_mps * kRestSpeedSigma_mps;
    if (variance < kUntoldSpeedSigma_mps * kUntoldSpeedSigma_mps) continue;
    const Vector3d axis = solver.eigenvectors().col(i);
    const double speed = axis.dot(start.state.velocity), gain = variance / (variance + rest);
    if (speed * speed > kMostRestMisfit * (variance + rest)) continue;
    start.state.velocity -= gain * speed * axis;
    covariance -= gain * variance * axis * axis.transpose();
  }
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
  start.isStatic = means.isStatic;
  start.state.time = startTime;
  const Matrix3d R_odom_vehicle = levelRotation(means.T_vehicle_imu.linear() * means.force);
  start.state.R_odom_imu = R_odom_vehicle * means.T_vehicle_imu.linear();
  start.state.position = R_odom_vehicle * means.T_vehicle_imu.translation();
  setSigma(start, kPosition, kPoseSigma);
  setSigma(start, kRotation, kPoseSigma);
  setSigma(start, kAccelBias, options.imu.accelBiasSigma_mps2);
  if (options.imu.estimateMounting) setSigma(start, kMounting, options.imu.mountingSigma_rad);
  if (options.imu.estimateTimeOffset)
    start.covariance(kTimeOffset, kTimeOffset) = options.imu.timeOffsetSigma_s * options.imu.timeOffsetSigma_s;
  if (start.isStatic) {
    start.state.gyroBias = means.gyroBias;
    setSigma(start, kGyroBias, 0.05 * options.imu.gyroBiasSigma_radps);
    setSigma(start, kVelocity, kStillSpeedSigma_mps);
  } else {
    setSigma(start, kGyroBias, options.imu.gyroBiasSigma_radps);
    setSigma(start, kVelocity, options.motion.initialSpeedSigma_mps);
  }
  start.covariance(kFloating, kFloating) = options.water.heaveSigma_m * options.water.heaveSigma_m;
  setGravity(start, options.imu.gravity_mps2, start.isStatic ? kTiltAccelStill_mps2 : kTiltAccelMoving_mps2);
  useHeave(means.T_vehicle_imu.inverse(), imu, end, options, start);
  return start;
}

StartState inEvenMotion(const StartState& atRest, const OdometryOptions& options) {
  StartState start = atRest;
  start.isStatic = false;
  setSigma(start, kVelocity, options.motion.initialSpeedSigma_mps);
  return start;
}

bool deniesRest(const StartState& start) {
  const Matrix3d covariance = start.covariance.block<3, 3>(kVelocity, kVelocity) +
                              kStillSpeedSigma_mps * kStillSpeedSigma_mps * Matrix3d::Identity();
  return start.state.velocity.dot(covariance.ldlt().solve(start.state.velocity)) > kMostRestMisfit;
}

StartState lidarOnlyStart(core::TimeNs startTime, const OdometryOptions& options) {
  StartState start;
  start.state.time = startTime;
  setSigma(start, kPosition, kPoseSigma);
  setSigma(start, kRotation, kPoseSigma);
  setSigma(start, kVelocity, options.motion.initialSpeedSigma_mps);
  setSigma(start, kGyroBias, options.motion.initialTurnRateSigma_radps);
  if (options.water.heavePrior) {
    setGravity(start, options.imu.gravity_mps2, options.water.leanSigma_rad * options.imu.gravity_mps2);
    start.covariance(kFloating, kFloating) = options.water.heaveSigma_m * options.water.heaveSigma_m;
  }
  return start;
}

StartState beforeAlignment(const StartState& rough, const StartState& refined) {
  StartState start = rough;
  start.state.velocity = refined.state.velocity;
  start.covariance.block<3, 3>(kVelocity, kVelocity) = refined.covariance.block<3, 3>(kVelocity, kVelocity);
  return start;
}

StartState levelled(const StartState& start) {
  const Matrix3d R = levelRotation(-start.state.gravity);
  StartState out = start;
  out.state.R_odom_imu = R * start.state.R_odom_imu;
  out.state.position = R * start.state.position;
  out.state.velocity = R * start.state.velocity;
  out.state.gravity = R * start.state.gravity;
  ErrorMatrix turn = ErrorMatrix::Identity();
  for (const int at : {kPosition, kVelocity, kGravity}) turn.block<3, 3>(at, at) = R;
  out.covariance = turn * start.covariance * turn.transpose();
  return out;
}

StartState refinedStart(const StartState& rough, const InertialFilter& early, const InertialFilter& rehearsed,
                        const ImuBuffer& imu, const OdometryOptions& options) {
  StartState start = rough;
  start.covariance = rough.covariance.diagonal().asDiagonal();  // its blocks are about to change
  const NavState& end = rehearsed.state();
  start.state.gyroBias = end.gyroBias;
  if (!rehearsed.hasImu()) {
    start.state.velocity = end.velocity;
    return start;
  }
  start.state.accelBias = end.accelBias;
  start.state.timeOffset_s = end.timeOffset_s;
  start.state.R_imu_readings = end.R_imu_readings;
  // The first vehicle frame, levelled anew: the correction turns the frame, not the vehicle.
  const core::Isometry T_imu_vehicle = imu.samples().front().T_vehicle_imu.inverse();
  const Matrix3d R_old_vehicle = rough.state.R_odom_imu * T_imu_vehicle.linear();
  const Matrix3d R_new_vehicle = levelRotation(R_old_vehicle.transpose() * -end.gravity);
  const Matrix3d R_new_old = R_new_vehicle * R_old_vehicle.transpose();
  start.state.R_odom_imu = R_new_old * rough.state.R_odom_imu;
  start.state.position = R_new_old * rough.state.position;
  setGravity(start, options.imu.gravity_mps2, 0);
  for (const int at : {kGyroBias, kAccelBias, kGravity, kMounting}) {
    const Vector3d widened = kRehearsalInflation * rehearsed.covariance().diagonal().segment<3>(at);
    start.covariance.diagonal().segment<3>(at) = widened.cwiseMin(rough.covariance.diagonal().segment<3>(at));
  }
  double& offsetVariance = start.covariance(kTimeOffset, kTimeOffset);
  offsetVariance = std::min(offsetVariance, kRehearsalInflation * rehearsed.covariance()(kTimeOffset, kTimeOffset));
  if (rough.isStatic) {
    useHeave(T_imu_vehicle, imu, end.time, options, start);
    return start;
  }
  // The speed at the start is the rehearsal's early one less what the IMU felt since.
  InertialFilter fromRest(options.imu, options.motion, true);
  NavState rest = start.state;
  rest.velocity.setZero();
  fromRest.reset(rest, ErrorMatrix::Zero());
  fromRest.propagate(imu.steps(rest.time, early.state().time, options.imu.maxGap_s, rest.timeOffset_s));
  start.state.velocity = R_new_old * early.state().velocity - fromRest.state().velocity;
  // On the way back to the start, what gravity and the accelerometer's bias leave open together grows to a speed.
  Eigen::Matrix<double, 3, kErrorSize> open = Eigen::Matrix<double, 3, kErrorSize>::Zero();
  open.middleCols<3>(kGravity).setIdentity();
  open.middleCols<3>(kAccelBias) = -end.R_odom_imu;
  const double back_s = core::secondsBetween(rest.time, early.state().time);
  setSigma(start, kVelocity, kRefinedSpeedSigma_mps);
  start.covariance.block<3, 3>(kVelocity, kVelocity) +=
      back_s * back_s * R_new_old * (open * rehearsed.covariance() * open.transpose()) * R_new_old.transpose();
  // Where nothing in sight tells the speed in some direction, the rehearsal has not learnt it either.
  start.covariance.block<3, 3>(kVelocity, kVelocity) +=
      R_new_old * early.covariance().block<3, 3>(kVelocity, kVelocity) * R_new_old.transpose();
  if (options.water.velocityPrior && leavesSpeedOpen(start)) {
    start.isSpeedOpen = true;
    assumeRest(start);
  }
  useHeave(T_imu_vehicle, imu, end.time, options, start);
  return start;
}

}  // namespace s2s::odometry
