#include "s2s/odometry/imu_calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "replay.h"

namespace s2s::odometry {
namespace {

using namespace synthetic;
using Eigen::Vector3d;
using testing::HasSubstr;

/// A vessel that rocks on short waves and turns, as in the field: what tells the clocks apart.
Record rockingRecord() {
  Record record;
  record.path = [](double t) {
    return core::isometryFromXyzYpr(2.0 * std::sin(0.35 * t), 1.5 * std::sin(0.27 * t + 0.4),
                                    0.8 + 0.02 * std::sin(3.3 * t), 0.5 * std::sin(0.4 * t), 0.03 * std::sin(3.9 * t),
                                    0.06 * std::sin(4.8 * t + 1));
  };
  record.duration_s = 20;
  record.lidar.columns = 180;
  return record;
}

TEST(ImuCalibrationOnline, TimeOffsetOf20ms_IsFoundWithin2msAndToldOf) {
  for (const double offset_s : {0.02, -0.02}) {
    Record record = rockingRecord();
    record.tamperImu = [offset_s](ImuSample& s) { return s.time += core::durationNs(offset_s), true; };
    const Replay run = replay(record);
    const ImuCalibration& imu = run.results.back().imu;
    EXPECT_NEAR(imu.timeOffset_s, offset_s, 0.002);
    EXPECT_LT(std::abs(imu.timeOffset_s - offset_s), 4 * imu.timeOffsetSigma_s);
    const auto told = contradictions(imu);
    ASSERT_EQ(told.size(), 1U);
    EXPECT_THAT(told[0], HasSubstr(offset_s > 0 ? "later" : "earlier"));
    // As without an offset: 1 cm ranges, and the first planes come from single sweeps.
    EXPECT_LT(worstError(run, record).translation_m, 0.03);
  }
}

TEST(ImuCalibrationOnline, TimeOffsetNotEstimated_CostsAccuracy) {
  Record record = rockingRecord();
  record.tamperImu = [](ImuSample& s) { return s.time += core::durationNs(0.05), true; };
  const double with = worstError(replay(record), record).rotation_rad;
  record.options.imu.estimateTimeOffset = false;
  const Replay without = replay(record);
  EXPECT_GT(worstError(without, record).rotation_rad, 1.5 * with);
  EXPECT_EQ(without.results.back().imu.timeOffset_s, 0);
}

TEST(ImuCalibrationOnline, MountingTurned_IsFoundAndToldOf) {
  Record record = rockingRecord();
  const Eigen::Matrix3d R_nominal_true = core::expSo3(Vector3d(0.02, -0.015, 0.03));
  core::Isometry T_vehicle_imu = record.T_vehicle_imu;
  T_vehicle_imu.linear() = (T_vehicle_imu.linear() * R_nominal_true).eval();
  const core::Isometry said = record.T_vehicle_imu;
  record.T_vehicle_imu = T_vehicle_imu;
  record.tamperImu = [said](ImuSample& s) { return s.T_vehicle_imu = said, true; };
  const ImuCalibration imu = replay(record).results.back().imu;
  // The prior of 0.6 deg pulls towards zero a little, and the odometry states how well it knows.
  EXPECT_LT((imu.turn_rad - core::logSo3(R_nominal_true)).norm(), 0.3 * M_PI / 180);
  const auto told = contradictions(imu);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_THAT(told[0], HasSubstr("turned against what their mountings say"));
}

TEST(ImuCalibrationOnline, NothingWrong_NothingIsTold) {
  const Replay run = replay(rockingRecord());
  EXPECT_TRUE(contradictions(run.results.back().imu).empty());
  EXPECT_NEAR(run.results.back().imu.timeOffset_s, 0, 0.002);
  EXPECT_LT(run.results.back().imu.turn_rad.norm(), 0.3 * M_PI / 180);
}

TEST(ImuCalibrationOnline, NotEstimated_StaysZero) {
  Record record = rockingRecord();
  record.duration_s = 3;
  record.options.imu.estimateTimeOffset = record.options.imu.estimateMounting = false;
  const ImuCalibration imu = replay(record).results.back().imu;
  EXPECT_EQ(imu.timeOffset_s, 0);
  EXPECT_EQ(imu.timeOffsetSigma_s, 0);
  EXPECT_EQ(imu.turn_rad.norm(), 0);
}

TEST(ImuBuffer, TimeOffset_ShiftsTheReadingsNotTheTimes) {
  ImuBuffer imu;
  for (int i = 0; i <= 100; ++i) {
    ImuSample sample;
    sample.time = timeOf(0.01 * i);
    sample.angularRate_radps = {0.01 * i, 0, 0};
    imu.add(sample);
  }
  const auto steps = imu.steps(timeOf(0.2), timeOf(0.3), 0.1, 0.05);
  ASSERT_FALSE(steps.empty());
  EXPECT_EQ(steps.back().end, timeOf(0.3));
  double angle = 0;
  for (const auto& step : steps) {
    angle += step.duration_s * step.angularRate_radps.x();
    EXPECT_NEAR(step.angularRateSlope_radps2.x(), 1.0, 1e-6);
  }
  EXPECT_NEAR(angle, 0.1 * 0.3, 1e-9);  // the mean of a rate of t rad/s from 0.25 s to 0.35 s
}

}  // namespace
}  // namespace s2s::odometry
