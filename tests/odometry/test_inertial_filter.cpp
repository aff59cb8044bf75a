#include <gtest/gtest.h>

#include "s2s/odometry/inertial_filter.h"
#include "synthetic.h"

namespace s2s::odometry {
namespace {

using Eigen::Vector3d;

NavState someState() {
  NavState state;
  state.position = {1, -2, 0.5};
  state.R_odom_imu = core::expSo3({0.3, -0.2, 0.9});
  state.velocity = {1.2, -0.4, 0.1};
  state.gyroBias = {0.01, -0.02, 0.03};
  state.accelBias = {0.1, 0.05, -0.08};
  state.gravity = {0.1, -0.05, -9.8};
  state.floatingHeight = 0.2;
  state.timeOffset_s = 0.01;
  state.R_imu_readings = core::expSo3({0.02, -0.03, 0.01});
  return state;
}

MotionStep someStep() {
  MotionStep step;
  step.end = core::durationNs(0.05);
  step.duration_s = 0.05;
  step.angularRate_radps = {0.4, -1.1, 0.7};
  step.specificForce_mps2 = {1.0, 2.0, 9.0};
  step.angularRateSlope_radps2 = {2.0, 0.5, -1.0};
  step.specificForceSlope_mps3 = {3.0, -2.0, 1.0};
  return step;
}

/// Greatest difference between F and central differences of the step itself.
double jacobianError(const MotionStep& step, bool hasImu) {
  const NavState state = someState();
  const auto model = propagated(state, step, {}, {}, hasImu);
  constexpr double h = 1e-5;
  double worst = 0;
  for (int i = 0; i < kErrorSize; ++i) {
    ErrorVector error = ErrorVector::Zero();
    error[i] = h;
    const NavState plus = propagated(moved(state, error), step, {}, {}, hasImu).state;
    const NavState minus = propagated(moved(state, -error), step, {}, {}, hasImu).state;
    const ErrorVector column = (errorBetween(model.state, plus) - errorBetween(model.state, minus)) / (2 * h);
    worst = std::max(worst, (column - model.F.col(i)).cwiseAbs().maxCoeff());
  }
  return worst;
}

TEST(InertialFilter, MeasuredStep_JacobianMatchesNumericDifferences) {
  // Central differences with h = 1e-5: truncation h^2 and rounding 1e-16 / h are both below 1e-9.
  EXPECT_LT(jacobianError(someStep(), true), 1e-8);
}

TEST(InertialFilter, BridgedStep_JacobianMatchesNumericDifferences) {
  MotionStep step = someStep();
  step.isMeasured = false;
  EXPECT_LT(jacobianError(step, true), 1e-8);
  EXPECT_LT(jacobianError(step, false), 1e-8);
}

TEST(InertialFilter, MovedAndErrorBetween_AreInverse) {
  ErrorVector error;
  for (int i = 0; i < kErrorSize; ++i) error[i] = 0.1 * std::sin(i + 1.0);
  EXPECT_LT((errorBetween(someState(), moved(someState(), error)) - error).norm(), 1e-12);
}

TEST(InertialFilter, ExactReadings_FollowTheAnalyticPath) {
  const auto path = synthetic::roomPath();
  synthetic::Random random(1);
  ImuBuffer imu;
  const core::Isometry T_vehicle_imu = core::isometryFromXyzYpr(0.3, 0.1, 0.5, 0.4, 0.1, -0.2);
  for (int i = 0; i <= 1000; ++i) imu.add(synthetic::imuAt(path, 0.01 * i, T_vehicle_imu, {}, random));
  const core::Isometry start = path(0) * T_vehicle_imu, end = path(10) * T_vehicle_imu;
  NavState state;
  state.time = synthetic::timeOf(0);
  state.position = start.translation();
  state.R_odom_imu = start.linear();
  state.velocity = ((path(1e-4) * T_vehicle_imu).translation() - (path(-1e-4) * T_vehicle_imu).translation()) / 2e-4;
  state.gravity = {0, 0, -9.81};
  InertialFilter filter({}, {}, true);
  filter.reset(state, ErrorMatrix::Zero());
  filter.propagate(imu.steps(synthetic::timeOf(0), synthetic::timeOf(10), 0.1));
  // Linear interpolation at 100 Hz leaves a second-order error: angular acceleration of some 0.1 rad/s^3 times
  // dt^2/12 over 10 s is about 1e-5 rad; tilt times gravity over 10 s then makes millimetres.
  EXPECT_LT(core::angleBetween(filter.state().R_odom_imu, end.linear()), 2e-5);
  EXPECT_LT((filter.state().position - end.translation()).norm(), 0.01);
}

TEST(InertialFilter, WithoutImu_SpeedAndTurnRateGoOn) {
  NavState state;
  state.velocity = {2, 1, 0};
  state.gyroBias = {0, 0, -0.5};  // serves as minus the turn rate
  InertialFilter filter({}, {}, false);
  filter.reset(state, ErrorMatrix::Zero());
  filter.propagate(ImuBuffer().steps(0, core::durationNs(2.0), 0.1));
  EXPECT_LT((filter.state().position - Vector3d(4, 2, 0)).norm(), 1e-9);
  EXPECT_LT(core::angleBetween(filter.state().R_odom_imu, core::expSo3({0, 0, 1.0})), 1e-9);
}

TEST(InertialFilter, WithoutImu_VarianceGrowsAsIntegratedWhiteAcceleration) {
  MotionOptions motion;
  motion.acceleration_mps2_rthz = 0.6;
  InertialFilter filter({}, motion, false);
  filter.reset({}, ErrorMatrix::Zero());
  filter.propagate(ImuBuffer().steps(0, core::durationNs(1.5), 0.1));
  // q t for the speed and q t^3 / 3 for the position.
  EXPECT_NEAR(filter.covariance()(kVelocity, kVelocity), 0.36 * 1.5, 1e-9);
  EXPECT_NEAR(filter.covariance()(kPosition, kPosition), 0.36 * 1.5 * 1.5 * 1.5 / 3, 1e-9);
}

ErrorMatrix someCovariance() {
  ErrorMatrix A;
  for (int r = 0; r < kErrorSize; ++r)
    for (int c = 0; c < kErrorSize; ++c) A(r, c) = std::sin(1.7 * r + 0.9 * c * c) + (r == c ? 3.0 : 0.0);
  return 1e-3 * A * A.transpose();
}

TEST(InertialFilter, PoseMeasurement_EqualsTheFullKalmanUpdate) {
  InertialFilter filter({}, {}, true);
  filter.reset(someState(), someCovariance());
  core::Isometry measured = someState().T_odom_imu();
  measured.translation() += Vector3d(1e-4, -2e-4, 3e-4);
  measured.linear() = measured.linear() * core::expSo3({1e-4, 2e-4, -1e-4});
  const core::Matrix6 noise = 1e-3 * core::Matrix6::Identity();
  filter.measurePose(measured, noise);

  const ErrorMatrix P = someCovariance();
  const Eigen::Matrix<double, kErrorSize, 6> K = P.leftCols<6>() * (P.topLeftCorner<6, 6>() + noise).inverse();
  core::Vector6 innovation;
  innovation << 1e-4, -2e-4, 3e-4, 1e-4, 2e-4, -1e-4;
  const ErrorMatrix expected = P - K * P.topRows<6>();
  EXPECT_LT((errorBetween(someState(), filter.state()) - K * innovation).norm(), 1e-7);  // second order of 1e-4
  EXPECT_LT((filter.covariance() - expected).norm(), 1e-9);
}

TEST(InertialFilter, HeaveMeasurement_PullsTheHeightByItsWeight) {
  InertialFilter filter({}, {}, true);
  NavState state;
  state.gravity = {0, 0, -9.81};
  state.position = {0, 0, 0.4};
  ErrorMatrix P = ErrorMatrix::Zero();
  P(kPosition + 2, kPosition + 2) = 0.09;
  filter.reset(state, P);
  const double misfit = filter.measureHeave(core::Isometry::Identity(), 0.0, 0.1);
  // Variances 0.09 and 0.01: the height goes nine tenths of the way, and 0.4 m is 0.4 / sqrt(0.1) sigma.
  EXPECT_NEAR(filter.state().position.z(), 0.04, 1e-12);
  EXPECT_NEAR(misfit, -0.4 / std::sqrt(0.1), 1e-12);
}

TEST(InertialFilter, PoseNees_IsWithinItsBounds) {
  // 400 runs with the filter's own noise and pose measurements every 0.1 s; the final error's NEES has 19 - 1 degrees
  // of freedom (nothing touches the floating height).
  constexpr int kRuns = 400;
  const auto path = synthetic::roomPath();
  ImuOptions options;
  double sum = 0;
  for (int run = 0; run < kRuns; ++run) {
    synthetic::Random random(100 + run);
    synthetic::ImuNoise noise{10 * options.gyroNoise_radps_rthz, 10 * options.accelNoise_mps2_rthz,
                              random.gaussian3(options.gyroBiasSigma_radps),
                              random.gaussian3(options.accelBiasSigma_mps2)};
    ImuBuffer imu;
    for (int i = 0; i <= 300; ++i) imu.add(synthetic::imuAt(path, 0.01 * i, core::Isometry::Identity(), noise, random));
    NavState truth;
    truth.time = synthetic::timeOf(0);
    truth.position = path(0).translation();
    truth.R_odom_imu = path(0).linear();
    truth.velocity = (path(1e-4).translation() - path(-1e-4).translation()) / 2e-4;
    truth.gravity = {0, 0, -9.81};
    ErrorMatrix P = ErrorMatrix::Zero();
    const auto setSigma = [&](int at, double sigma) { P.diagonal().segment<3>(at).setConstant(sigma * sigma); };
    setSigma(kPosition, 0.05);
    setSigma(kRotation, 0.02);
    setSigma(kVelocity, 0.2);
    setSigma(kGravity, 0.05);
    ErrorVector off = ErrorVector::Zero();
    for (const auto& [at, sigma] : {std::pair{kPosition, 0.05}, {kRotation, 0.02}, {kVelocity, 0.2}, {kGravity, 0.05}})
      off.segment<3>(at) = random.gaussian3(sigma);
    setSigma(kGyroBias, options.gyroBiasSigma_radps);
    setSigma(kAccelBias, options.accelBiasSigma_mps2);
    P(kFloating, kFloating) = 1;
    options.gyroBiasWalk_radps2_rthz = options.accelBiasWalk_mps3_rthz = 0;
    InertialFilter filter(options, {}, true);
    filter.reset(moved(truth, off), P);
    core::Matrix6 R = core::Matrix6::Identity();
    R.topLeftCorner<3, 3>() *= 0.02 * 0.02;
    R.bottomRightCorner<3, 3>() *= 0.003 * 0.003;
    for (int i = 1; i <= 30; ++i) {
      filter.propagate(imu.steps(filter.state().time, synthetic::timeOf(0.1 * i), 0.1));
      core::Isometry measured = path(0.1 * i);
      measured.translation() += random.gaussian3(0.02);
      measured.linear() = measured.linear() * core::expSo3(random.gaussian3(0.003));
      filter.measurePose(measured, R);
    }
    NavState end = truth;
    end.position = path(3).translation();
    end.R_odom_imu = path(3).linear();
    end.velocity = (path(3 + 1e-4).translation() - path(3 - 1e-4).translation()) / 2e-4;
    end.gyroBias = noise.gyroBias;
    end.accelBias = noise.accelBias;
    const ErrorVector error = errorBetween(filter.state(), end);
    sum += error.head<18>().dot(filter.covariance().topLeftCorner<18, 18>().ldlt().solve(error.head<18>()));
  }
  // 95 % of chi-square with 7200 degrees of freedom, divided by 400.
  EXPECT_GT(sum / kRuns, 17.41);
  EXPECT_LT(sum / kRuns, 18.59);
}

}  // namespace
}  // namespace s2s::odometry
