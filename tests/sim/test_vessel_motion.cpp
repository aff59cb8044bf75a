#include <gtest/gtest.h>

#include "s2s/sim/imu_model.h"
#include "s2s/sim/vessel_motion.h"

using namespace s2s;
using Eigen::Vector3d;

namespace {

sim::Experiment lap() {
  sim::Experiment e;
  e.number = 1;
  e.waypoints_m = {{0, 0}, {40, 0}, {45, -6}, {40, -12}, {0, -12}};
  e.speed_mps = 1.3;
  return e;
}

sim::VesselMotion motionOf(const sim::WaveOptions& waves = {}) { return {lap(), {}, waves, 3}; }

}  // namespace

TEST(VesselMotion, Derivatives_AreThoseOfThePose) {
  const sim::VesselMotion motion = motionOf();
  constexpr double h = 1e-4;
  for (double t = 3; t < 60; t += 1.37) {
    const auto s = motion.at(t), before = motion.at(t - h), after = motion.at(t + h);
    const Vector3d v = (after.T_world_vehicle.translation() - before.T_world_vehicle.translation()) / (2 * h);
    const Vector3d a = (after.velocity_world_mps - before.velocity_world_mps) / (2 * h);
    const Vector3d w =
        core::logSo3(before.T_world_vehicle.linear().transpose() * after.T_world_vehicle.linear()) / (2 * h);
    const Vector3d dw = (after.rate_body_radps - before.rate_body_radps) / (2 * h);
    // Central differences over 0.1 ms: truncation about 1e-8, rounding about 1e-16 / h.
    EXPECT_LT((v - s.velocity_world_mps).norm(), 1e-6);
    EXPECT_LT((a - s.acceleration_world_mps2).norm(), 1e-6);
    EXPECT_LT((w - s.rate_body_radps).norm(), 1e-6);
    EXPECT_LT((dw - s.rateDerivative_body_radps2).norm(), 1e-6);
  }
}

TEST(VesselMotion, PlannedWay_IsFollowedToItsEnd) {
  const sim::VesselMotion motion = motionOf();
  const Vector3d end = motion.pose(motion.duration_s()).translation();
  EXPECT_LT((end.head<2>() - Eigen::Vector2d(0, -12)).norm(), 1.5);  // it passes the last waypoint at its own pace
  // In the middle of the first leg it goes straight at the planned speed.
  const auto s = motion.at(20);
  EXPECT_NEAR(s.T_world_vehicle.translation().y(), 0, 0.3);
  EXPECT_NEAR(s.velocity_world_mps.head<2>().norm(), 1.3, 0.02);
}

TEST(VesselMotion, Start_IsStillButForTheWaves) {
  const auto s = motionOf().at(0.5);
  EXPECT_NEAR(s.velocity_world_mps.head<2>().norm(), 0, 1e-9);
  EXPECT_GT(std::abs(s.velocity_world_mps.z()), 0);
}

TEST(WaveMotion, Heave_HasTheSignificantHeightAskedFor) {
  sim::WaveOptions o;
  o.significantHeight_m = 0.2;
  o.components = 60;
  const sim::WaveMotion waves(o, 5);
  double squares = 0;
  constexpr int kCount = 40000;
  for (int i = 0; i < kCount; ++i) squares += std::pow(waves.heave(0.37 * i).value, 2);
  // Hs = 4 sigma; the components cover 0.6 to 2.4 of the peak frequency, which holds 95 % of the spectrum's variance,
  // and are drawn at random places: 10 %.
  EXPECT_NEAR(4 * std::sqrt(squares / kCount), 0.2, 0.02);
}

TEST(WaveMotion, SwitchedOff_IsZero) {
  sim::WaveOptions o;
  o.enabled = false;
  const sim::WaveMotion waves(o, 5);
  EXPECT_EQ(waves.heave(3).value, 0);
  EXPECT_EQ(waves.roll(3).first, 0);
}

TEST(ImuModel, NoiseFreeSamplesIntegratedOver60s_ReturnToTheTruePose) {
  const sim::VesselMotion motion = motionOf();
  sim::ImuOptions o;
  o.noise = false;
  o.T_vehicle_imu = core::isometryFromXyzYpr(0.2, -0.1, 1.0, 0.3, -0.1, 0.05);
  const auto truth = [&](double t) { return sim::inertialTruth(motion.at(t), o.T_vehicle_imu, o.gravity_mps2); };
  const auto pose = [&](double t) { return motion.pose(t) * o.T_vehicle_imu; };

  // Strapdown integration of the 100 Hz samples, Runge-Kutta of fourth order over pairs of them.
  constexpr double kStep = 0.02, kStart = 1.0, kDuration = 60;
  Eigen::Matrix3d R = pose(kStart).linear();
  Vector3d p = pose(kStart).translation();
  Vector3d v = (pose(kStart + 1e-5).translation() - pose(kStart - 1e-5).translation()) / 2e-5;
  const Vector3d gravity(0, 0, -o.gravity_mps2);
  for (int i = 0; i < static_cast<int>(kDuration / kStep); ++i) {
    const double t = kStart + i * kStep;
    const auto s0 = truth(t), s1 = truth(t + kStep / 2), s2 = truth(t + kStep);
    // Rotation vector over the step, with the coning term of a linearly changing rate.
    const Vector3d mean = (s0.rate_radps + 4 * s1.rate_radps + s2.rate_radps) / 6;
    const Vector3d half = (5 * s0.rate_radps + 8 * s1.rate_radps - s2.rate_radps) / 24 * kStep;
    const Vector3d full = mean * kStep + s0.rate_radps.cross(s2.rate_radps) * kStep * kStep / 12;
    const Eigen::Matrix3d R1 = R * core::expSo3(half), R2 = R * core::expSo3(full);
    const Vector3d a0 = R * s0.force_mps2 + gravity, a1 = R1 * s1.force_mps2 + gravity,
                   a2 = R2 * s2.force_mps2 + gravity;
    p += v * kStep + (a0 + 2 * a1) * kStep * kStep / 6;
    v += (a0 + 4 * a1 + a2) * kStep / 6;
    R = R2;
  }
  const core::Isometry end = pose(kStart + kDuration);
  EXPECT_LT((p - end.translation()).norm(), 0.01);                    // the promise: 1 cm
  EXPECT_LT(core::angleBetween(R, end.linear()) * 180 / M_PI, 0.01);  // the promise: 0.01 degrees
}

TEST(ImuModel, AtRestWithoutNoise_FeelsGravityUpwards) {
  sim::WaveOptions still;
  still.enabled = false;
  sim::ImuOptions o;
  o.noise = false;
  sim::ImuModel imu(o, 1);
  const auto sample = imu.sample(motionOf(still), 0.5, 0);
  EXPECT_NEAR(sample->get(mrpt::obs::IMU_Z_ACC), 9.81, 1e-9);
  EXPECT_NEAR(sample->get(mrpt::obs::IMU_X_ACC), 0, 1e-9);
  EXPECT_NEAR(sample->get(mrpt::obs::IMU_WZ), 0, 1e-12);
}

TEST(ImuModel, WhiteNoise_HasTheDensityAskedFor) {
  sim::WaveOptions still;
  still.enabled = false;
  sim::VesselOptions vessel;
  vessel.startStill_s = 100;
  const sim::VesselMotion motion(lap(), vessel, still, 1);
  sim::ImuOptions o;
  o.accBias_mps2 = o.gyroBias_radps = o.accBiasWalk_mps3PerRtHz = o.gyroBiasWalk_radps2PerRtHz = 0;
  o.accScale = o.gyroScale = 0;
  sim::ImuModel imu(o, 1);
  double squares = 0;
  constexpr int kCount = 5000;
  for (int i = 0; i < kCount; ++i) squares += std::pow(imu.sample(motion, 0.01 * i, 0)->get(mrpt::obs::IMU_WX), 2);
  // sigma = density * sqrt(rate); the estimate from 5000 samples is good to 1 %, four times that allowed.
  EXPECT_NEAR(std::sqrt(squares / kCount) / (o.gyroNoiseDensity_radpsPerRtHz * 10), 1, 0.04);
}
