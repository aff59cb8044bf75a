#include <gtest/gtest.h>

#include "replay.h"

namespace s2s::odometry {
namespace {

using namespace synthetic;

double secondsOf(core::TimeNs time) { return core::secondsBetween(timeOf(0), time); }

TEST(OdometryFaults, ImuSilentForASecond_IsBridged) {
  Record record;
  record.tamperImu = [](ImuSample& s) { return secondsOf(s.time) < 5.0 || secondsOf(s.time) > 6.0; };
  const Replay run = replay(record);
  ASSERT_EQ(run.results.size(), 120U);
  EXPECT_GE(run.faults.imuGaps, 9U);
  EXPECT_LT(worstError(run, record).translation_m, 0.05);
}

TEST(OdometryFaults, ImuEndsForGood_OdometryGoesOn) {
  Record record;
  record.tamperImu = [](ImuSample& s) { return secondsOf(s.time) < 6.0; };
  const Replay run = replay(record);
  ASSERT_EQ(run.results.size(), 120U);
  EXPECT_LT(worstError(run, record).translation_m, 0.06);
}

TEST(OdometryFaults, LidarSilentForLong_OldImuSamplesAreForgotten) {
  const Record record;
  const Path still = [](double) { return core::isometryFromXyzYpr(0.5, 0.2, 0.8, 0.3, 0.04, -0.06); };
  constexpr double kBack_s = 408;
  Random random(record.seed);
  LidarInertialOdometry odometry(record.options);
  std::size_t results = 0;
  OdometryResult last;
  for (int i = 0; 0.01 * i < kBack_s + 1; ++i) {
    odometry.addImu(imuAt(still, 0.01 * i, record.T_vehicle_imu, record.noise, random));
    if (i % 10 != 0 || (i >= 800 && 0.01 * i < kBack_s)) continue;
    odometry.addScan(scanAt(record.world, still, 0.01 * i, record.lidar, random));
    while (auto result = odometry.next()) last = std::move(*result), ++results;
  }
  EXPECT_GT(results, 80U);
  // Five minutes are kept, so the scan that ends the silence of nearly seven has to bridge the rest, and only that one.
  EXPECT_EQ(odometry.faults().imuGaps, 1U);
  EXPECT_EQ(last.status, OdometryStatus::registered);
}

TEST(OdometryFaults, NotFiniteAndBackwardImu_AreRefusedAndCounted) {
  Record record;
  std::size_t count = 0, spoilt = 0;
  record.tamperImu = [&](ImuSample& s) {
    ++count;
    if (count % 50 == 0) s.angularRate_radps.x() = std::nan("");
    if (count % 70 == 0) s.time -= core::durationNs(3);
    spoilt += count % 50 == 0 || count % 70 == 0;
    return true;
  };
  const Replay run = replay(record);
  EXPECT_EQ(run.faults.imuRefused, spoilt);
  EXPECT_LT(worstError(run, record).translation_m, 0.02);
}

TEST(OdometryFaults, EmptyAndRepeatedScans_AreSkippedWithTheirReason) {
  Record record;
  int count = 0;
  record.tamperScan = [&](Scan& scan) {
    ++count;
    if (count == 30) scan.points_sensor.clear(), scan.offset_s.clear();
    if (count == 40) scan.time -= core::durationNs(2.0);
    return count < 50 || count > 55;  // and half a second of scans is lost
  };
  const Replay run = replay(record);
  ASSERT_EQ(run.results.size(), 114U);
  EXPECT_EQ(run.results[29].status, OdometryStatus::skipped);
  EXPECT_EQ(run.results[29].reason, OdometryReason::emptyScan);
  EXPECT_EQ(run.results[39].reason, OdometryReason::timeNotIncreasing);
  EXPECT_EQ(run.faults.scansEmpty, 1U);
  EXPECT_EQ(run.faults.scansTimeNotIncreasing, 1U);
  EXPECT_LT(worstError(run, record).translation_m, 0.02);
}

TEST(OdometryFaults, EmptyFirstScan_DoesNotStartTheOdometry) {
  Record record;
  record.duration_s = 4;
  int count = 0;
  record.tamperScan = [&](Scan& scan) {
    if (++count == 1) scan.points_sensor.clear(), scan.offset_s.clear();
    return true;
  };
  const Replay run = replay(record);
  ASSERT_EQ(run.results.size(), 40U);
  EXPECT_EQ(run.results[0].status, OdometryStatus::skipped);
  EXPECT_EQ(run.results[1].status, OdometryStatus::firstScan);
}

TEST(OdometryFaults, ScansBeforeTheImu_AreProcessedAllTheSame) {
  Record record;
  record.tamperImu = [](ImuSample& s) { return secondsOf(s.time) > 0.4; };
  const Replay run = replay(record);
  ASSERT_EQ(run.results.size(), 120U);
  EXPECT_TRUE(run.usedImu);
  EXPECT_LT(worstError(run, record).translation_m, 0.05);
}

TEST(OdometryFaults, ImuThatComesLate_IsIgnoredAndCounted) {
  Record record;
  record.tamperImu = [](ImuSample& s) { return secondsOf(s.time) > 4.0; };
  const Replay run = replay(record);
  ASSERT_EQ(run.results.size(), 120U);
  EXPECT_FALSE(run.usedImu);
  EXPECT_GT(run.faults.imuIgnored, 700U);
  EXPECT_LT(worstError(run, record).translation_m, 0.03);
}

TEST(OdometryFaults, HardlyAnyPoint_IsDeadReckoned) {
  Record record;
  record.duration_s = 6;
  int count = 0;
  record.tamperScan = [&](Scan& scan) {
    if (++count > 40 && count <= 45) {
      scan.points_sensor.resize(20);
      scan.offset_s.resize(20);
    }
    return true;
  };
  const Replay run = replay(record);
  EXPECT_EQ(run.results[42].status, OdometryStatus::deadReckoned);
  EXPECT_EQ(run.results[42].reason, OdometryReason::tooFewMatches);
  EXPECT_EQ(run.faults.scansDeadReckoned, 5U);
  EXPECT_GT(run.results[44].covariance_pose(0, 0), run.results[39].covariance_pose(0, 0));
  EXPECT_LT(worstError(run, record).translation_m, 0.05);
}

TEST(OdometryFaults, NothingAtAll_GivesNothing) {
  LidarInertialOdometry odometry{OdometryOptions()};
  EXPECT_FALSE(odometry.next().has_value());
  odometry.finish();
  EXPECT_FALSE(odometry.next().has_value());
  EXPECT_TRUE(odometry.trajectory().empty());
}

}  // namespace
}  // namespace s2s::odometry
