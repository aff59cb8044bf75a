#include <gtest/gtest.h>

#include <iostream>

#include "replay.h"

namespace s2s::odometry {
namespace {

using namespace synthetic;
using Eigen::Vector3d;

/// Up in the odometry's frame, seen through a result's pose.
Vector3d trueUp(const OdometryResult& result, const Record& record) {
  const core::Isometry truth = record.path(core::secondsBetween(timeOf(0), result.time));
  return result.T_odom_vehicle.linear() * truth.linear().transpose() * Vector3d::UnitZ();
}

TEST(Odometry, RoomWithImu_FollowsTheTruthAndFindsBiasesAndGravity) {
  const Record record;
  const Replay run = replay(record);
  ASSERT_EQ(run.results.size(), 120U);
  EXPECT_TRUE(run.usedImu);
  const Worst worst = worstError(run, record);
  // 1 cm ranges, some 1800 points a sweep; the first planes come from single sweeps.
  EXPECT_LT(worst.translation_m, 0.02);
  EXPECT_LT(worst.rotation_rad, 0.002);
  const auto& last = run.results.back();
  EXPECT_EQ(last.status, OdometryStatus::registered);
  EXPECT_LT((last.gyroBias_radps - record.noise.gyroBias).norm(), 0.0005);
  // The first level is a mean over a second of motion; afterwards the estimate must find the true vertical.
  EXPECT_LT((last.up_odom - trueUp(last, record)).norm(), 4 * last.gravitySigma_rad);
  EXPECT_LT((last.up_odom - trueUp(last, record)).norm(), 0.005);
}

TEST(Odometry, RoomWithoutImu_FollowsTheTruth) {
  Record record;
  record.hasImu = false;
  const Replay run = replay(record);
  ASSERT_EQ(run.results.size(), 120U);
  EXPECT_FALSE(run.usedImu);
  const Worst worst = worstError(run, record);
  // Within a sweep the motion is taken as uniform: at 0.3 rad/s^2 that leaves a milliradian.
  EXPECT_LT(worst.translation_m, 0.03);
  EXPECT_LT(worst.rotation_rad, 0.004);
}

TEST(Odometry, RoomWithoutImuAndPointTimes_StaysNearTheTruth) {
  Record record;
  record.hasImu = false;
  record.hasPointTimes = false;
  const Replay run = replay(record);
  ASSERT_EQ(run.results.size(), 120U);
  const Worst worst = worstError(run, record);
  // Undeskewed sweeps at up to 1.0 m/s and 0.2 rad/s are smeared by 0.1 m and 0.02 rad, and each of the two poses
  // compared may lag that much.
  EXPECT_LT(worst.translation_m, 0.2);
  EXPECT_LT(worst.rotation_rad, 0.04);
}

TEST(Odometry, HighRateTrajectory_FollowsTheTruthBetweenScans) {
  const Record record;
  const Replay run = replay(record);
  const auto& poses = run.trajectory.poses();
  EXPECT_GT(poses.size(), 1100U);  // 12 s at 100 Hz, and a pose at each scan's end
  EXPECT_EQ(poses.front().time, timeOf(0));
  for (const auto& result : run.results) {
    const auto T = run.trajectory.at(result.time);
    ASSERT_TRUE(T.has_value());
    EXPECT_LT((T->translation() - result.T_odom_vehicle.translation()).norm(), 1e-9);
  }
  const auto truth = [&](core::TimeNs time) { return record.path(core::secondsBetween(timeOf(0), time)); };
  for (std::size_t i = 100; i < poses.size(); ++i) {
    const core::Isometry ours = poses[100].T.inverse() * poses[i].T;
    const core::Isometry error = (truth(poses[100].time).inverse() * truth(poses[i].time)).inverse() * ours;
    EXPECT_LT(error.translation().norm(), 0.02);
    EXPECT_LT(core::logSo3(error.linear()).norm(), 0.003);
  }
}

TEST(Odometry, EvenMotionFromTheStart_IsNotTakenForRest) {
  // On flat water an IMU feels nothing of a steady speed.
  Record record;
  record.world = canal();
  record.path = [](double t) {
    core::Isometry T = core::Isometry::Identity();
    T.translation() = Eigen::Vector3d(20 + 1.2 * t, 0, 0);
    return T;
  };
  const Replay run = replay(record);
  const auto& first = run.results.front();
  // The scans of the first second tell the speed to some cm/s.
  EXPECT_NEAR(first.velocity_odom.norm(), 1.2, 0.1);
  // Along and across, as in the other runs of this canal; the height between walls is another test's matter.
  EXPECT_LT(errorAt(run, record, run.results.size() - 1).translation().head<2>().norm(), 0.1);
}

TEST(Odometry, RestBeforeSettingOff_TellsTheGyrosBias) {
  Record record;
  record.path = [](double t) {
    const double under_way_s = std::max(0.0, t - 2.5);
    core::Isometry T = roomPath()(0);
    // Away at 0.5 m/s^2 for two seconds, turning.
    const double s = std::min(under_way_s, 2.0);
    T.translation() += T.linear() * Eigen::Vector3d(0.25 * s * s, 0, 0);
    T.linear() = T.linear() * Eigen::AngleAxisd(0.1 * s * s, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    return T;
  };
  record.duration_s = 8;
  const Replay run = replay(record);
  // 1.9 s of rest at 100 Hz and 0.002 rad/s a sample: 0.15 mrad/s; four of these, and three axes.
  EXPECT_LT((run.results.front().gyroBias_radps - record.noise.gyroBias).norm(), 0.001);
  EXPECT_LT(run.results.front().velocity_odom.norm(), 0.02);
}

TEST(Odometry, StandingStill_StartsStaticallyAndDoesNotDrift) {
  Record record;
  record.path = [](double) { return core::isometryFromXyzYpr(0.5, 0.2, 0.8, 0.3, 0.04, -0.06); };
  const Replay run = replay(record);
  const Worst worst = worstError(run, record);
  EXPECT_LT(worst.translation_m, 0.01);
  EXPECT_LT(worst.rotation_rad, 0.001);
  // At rest the accelerometer's bias cannot be told from tilt: 0.036 m/s^2 are 3.7 mrad.
  EXPECT_LT((run.results.back().up_odom - trueUp(run.results.back(), record)).norm(), 0.006);
  EXPECT_LT((run.results.front().gyroBias_radps - record.noise.gyroBias).norm(), 0.0006);
}

TEST(Odometry, Corridor_IsFlaggedAndItsUncertaintyGrowsAlongIt) {
  Record record;
  record.world = corridor();
  record.path = cruise(1.0, 0, 0);
  record.duration_s = 10;
  const Replay run = replay(record);
  std::size_t flagged = 0;
  for (const auto& result : run.results) flagged += result.status == OdometryStatus::degenerate;
  EXPECT_GT(flagged, run.results.size() * 9 / 10);
  const auto& last = run.results.back();
  ASSERT_FALSE(last.degenerateMotions.empty());
  // The motion unseen is along the corridor, up to the vessel's yaw.
  EXPECT_GT(std::abs(last.degenerateMotions.front().head<3>().normalized().x()), 0.95);
  const double t = core::secondsBetween(timeOf(0), last.time);
  const Eigen::Matrix3d R_world_vehicle = record.path(t).linear();
  const Vector3d error = R_world_vehicle * errorAt(run, record, run.results.size() - 1).translation();
  const Eigen::Matrix3d covariance =
      R_world_vehicle * last.covariance_pose.topLeftCorner<3, 3>() * R_world_vehicle.transpose();
  const double along = std::sqrt(covariance(0, 0)), across = std::sqrt(covariance(1, 1));
  EXPECT_GT(along, 10 * across);
  // Held by the IMU: the way along is wrong by what its uncertainty says, and across stays exact.
  EXPECT_LT(std::abs(error.x()), 3 * along);
  EXPECT_LT(std::abs(error.y()), 0.05);
}

/// A vessel along a corridor, whose way along no LiDAR tells; under it a seabed that the sonars see.
Record overSeabed(Seabed seabed) {
  Record record;
  record.world = corridor();
  // At rest while the start is looked at: a speed that nothing has told before the first map is made is not found
  // later.
  record.path = [](double t) {
    const double under_way_s = std::max(0.0, t - 7);
    core::Isometry T = cruise(0.0, 0, 0)(t);
    T.translation().x() = under_way_s < 4 ? 0.125 * under_way_s * under_way_s : 2 + (under_way_s - 4);
    return T;
  };
  record.duration_s = 19;
  record.options.water.velocityPrior = false;
  record.seabed = std::move(seabed);
  return record;
}

double lastErrorAlong(const Replay& run, const Record& record) {
  const double t = core::secondsBetween(timeOf(0), run.results.back().time);
  return (record.path(t).linear() * errorAt(run, record, run.results.size() - 1).translation()).x();
}

TEST(Odometry, CorridorOverRipples_SonarHoldsTheWayAlong) {
  // Ripples of 10 cm by 1.1 m: slopes of up to 0.29, seen by 600 points of 4 cm ten times a second.
  Record record = overSeabed([](double x, double y) { return -3 + 0.05 * std::sin(2 * M_PI * (x + 0.3 * y) / 1.1); });
  Replay with;
  for (const unsigned seed : {2U, 3U, 4U, 1U}) {
    record.seed = seed;
    with = replay(record);
    // The map of the seabed is renewed every 3 m, four times on this way; cells with some 50 points tell the way to
    // about 4 cm / 0.2 / sqrt(cells in sight * 50) < 1 cm. Locked onto the next ripple it would be off by 1.1 m.
    EXPECT_LT(std::abs(lastErrorAlong(with, record)), 0.1) << "seed " << seed;
    std::size_t matched = 0;
    for (const auto& result : with.results) matched += result.seabedMatchCount > 0;
    EXPECT_GT(matched, with.results.size() * 8 / 10) << "seed " << seed;
  }
  const Eigen::Matrix3d R = record.path(record.duration_s).linear();
  const auto along = [&](const Replay& run) {
    return std::sqrt((R * run.results.back().covariance_pose.topLeftCorner<3, 3>() * R.transpose())(0, 0));
  };
  record.options.seabed.enabled = false;
  const Replay without = replay(record);
  EXPECT_LT(along(with), 0.2 * along(without));
}

TEST(Odometry, StartWhereTheScansAreBlind_BiasesAreRightFromTheFirstPose) {
  // A vessel lies about still in a corridor, over ripples; the walls tell its turns, so that a start found scan by scan
  // would do here, too. What is asked is that the start found from all points at once is right and knows its clock.
  Record record = overSeabed([](double x, double y) { return -3 + 0.05 * std::sin(2 * M_PI * (x + 0.3 * y) / 1.1); });
  record.options.water.velocityPrior = true;
  for (const unsigned seed : {2U, 3U, 4U, 1U}) {
    record.seed = seed;
    const Replay run = replay(record);
    // Six seconds of turns between walls known to some 2 mrad: 2 / 6 < 0.5 mrad/s an axis; the prior is 10 mrad/s.
    EXPECT_LT((run.results.front().gyroBias_radps - record.noise.gyroBias).norm(), 8.7e-4) << "seed " << seed;
    // As over ripples with a speed told.
    EXPECT_LT(std::abs(lastErrorAlong(run, record)), 0.1) << "seed " << seed;
    // No clock is off, nor is it found to be: five standard deviations, as the warning asks for.
    const ImuCalibration& imu = run.results.back().imu;
    EXPECT_LT(std::abs(imu.timeOffset_s), 5 * imu.timeOffsetSigma_s) << "seed " << seed;
  }
}

TEST(Odometry, StartUnderWayWhereTheScansAreBlind_SpeedIsFound) {
  // Along a corridor, which hides the speed from the LiDAR as rest and even motion are one to the IMU; an uneven seabed
  // tells it, if it is looked at as a whole.
  Record record = overSeabed([](double x, double y) {
    return -3 + 0.05 * std::sin(2 * M_PI * (x + 0.3 * y) / 1.7) + 0.05 * std::sin(2 * M_PI * (0.4 * x - y) / 2.3);
  });
  record.options.water.velocityPrior = true;
  record.duration_s = 8;  // the start looks at 6 s
  for (const double speed_mps : {-0.7, 0.0, 0.6, 1.2, 2.2}) {
    record.path = cruise(speed_mps, 0, 0);
    const Replay run = replay(record);
    const auto& first = run.results.front();
    const core::Isometry before = record.path(0.099), after = record.path(0.101);
    const Vector3d moved_m = after.translation() - before.translation();
    // Both in the vehicle's axes, as the frames differ by a heading.
    const Vector3d truth = record.path(0.1).linear().transpose() * moved_m / 0.002;
    const Vector3d found = first.T_odom_vehicle.linear().transpose() * first.velocity_odom;
    // 0.04 m of noise over slopes of 0.15, a thousand independent points in 6 s: 0.04 / 0.15 / 30 / 3 s = 3 mm/s; what
    // the tilt leaves open grows by 0.01 m/s^2 (accelerometer) in 6 s to 0.06 m/s.
    EXPECT_LT((found - truth).norm(), 0.1) << speed_mps << " m/s";
  }
}

TEST(Odometry, CorridorOverFlatSeabed_InventsNoKnowledge) {
  const Record record = overSeabed([](double, double) { return -3.0; });
  const Replay run = replay(record);
  const double t = core::secondsBetween(timeOf(0), run.results.back().time);
  const Eigen::Matrix3d R = record.path(t).linear();
  const double along = std::sqrt((R * run.results.back().covariance_pose.topLeftCorner<3, 3>() * R.transpose())(0, 0));
  // A flat seabed says nothing about the way along: what is known of it must cover the error.
  EXPECT_LT(std::abs(lastErrorAlong(run, record)), 3 * along);
}

TEST(Odometry, AcousticScansOutOfReach_AreLeftOut) {
  Record record;
  record.duration_s = 3;
  const Replay plain = replay(record);
  // All at one moment long before the first scan: no pose is known for them.
  LidarInertialOdometry odometry(record.options);
  Random random(record.seed);
  odometry.addAcoustic(acousticAt([](double, double) { return -3.0; }, record.path, -100, 0.04, random));
  EXPECT_TRUE(odometry.expectedMotion(timeOf(0), timeOf(1)).isApprox(core::Isometry::Identity()));
  for (int i = 0; i < 30; ++i) odometry.addScan(scanAt(record.world, record.path, 0.1 * i, record.lidar, random));
  odometry.finish();
  std::size_t count = 0;
  while (const auto result = odometry.next()) {
    EXPECT_EQ(result->seabedMatchCount, 0U);
    ++count;
  }
  EXPECT_EQ(count, plain.results.size());
}

TEST(Odometry, ExpectedMotion_IsThatOfThePath) {
  const Record record;
  Random random(1);
  LidarInertialOdometry odometry(record.options);
  for (int i = 0; i < 300; ++i) odometry.addImu(imuAt(record.path, 0.01 * i, record.T_vehicle_imu, {}, random));
  for (int i = 0; i < 29; ++i) odometry.addScan(scanAt(record.world, record.path, 0.1 * i, record.lidar, random));
  odometry.finish();
  while (odometry.next()) {
  }
  // From 30 ms before the last pose to 30 ms after it, at up to 1 m/s^2 and 0.3 rad/s^2 beside constant motion.
  const core::Isometry truth = record.path(2.87).inverse() * record.path(2.93);
  const core::Isometry error = truth.inverse() * odometry.expectedMotion(timeOf(2.87), timeOf(2.93));
  EXPECT_LT(error.translation().norm(), 0.006);
  EXPECT_LT(core::logSo3(error.linear()).norm(), 0.002);
}

TEST(Odometry, Canal_HeaveKnowledgeHoldsTheHeight) {
  // Hardly anything but vertical walls in sight.
  Record record;
  record.world = canal();
  record.path = cruise(1.3, 0, 0);
  record.duration_s = 25;
  record.lidar.columns = 360;
  const Replay with = replay(record);
  const core::Isometry error = errorAt(with, record, with.results.size() - 1);
  // The heave of 5 cm; along and across the walls and house corners hold.
  EXPECT_LT(std::abs(error.translation().z()), 0.05);
  EXPECT_LT(error.translation().head<2>().norm(), 0.1);
}

TEST(Odometry, PoseNees_IsHonestOverMonteCarloRuns) {
  constexpr int kRuns = 50;
  double sum = 0;
  for (int run = 0; run < kRuns; ++run) {
    Random random(900 + run);
    Record record;
    record.seed = 40 + run;
    record.duration_s = 3;
    record.lidar.rows = 24;
    record.lidar.columns = 180;
    record.noise.gyroBias = random.gaussian3(0.004);
    record.noise.accelBias = random.gaussian3(0.04);
    const double t0 = 20 * random.uniform();
    record.path = [t0](double t) { return roomPath()(t0 + t); };
    const Replay result = replay(record);
    MotionAccumulator accumulator;
    for (const auto& r : result.results) accumulator.add(r);
    const auto motion = accumulator.motion();
    const core::Isometry error = errorAt(result, record, result.results.size() - 1);
    core::Vector6 e;
    e << error.translation(), core::logSo3(error.linear());
    sum += e.dot(motion.covariance.ldlt().solve(e));
  }
  std::cout << "mean NEES " << sum / kRuns << " (6 is ideal)\n";
  // The middle 95 % of chi-square with 300 degrees of freedom, divided by 50.
  EXPECT_GT(sum / kRuns, 5.07);
  EXPECT_LT(sum / kRuns, 7.00);
}

TEST(Odometry, OwnHullAndWater_AreCountedAndLeftOut) {
  Record record;
  record.options.water.rejectBelow = true;
  record.options.water.height_m = -1.5;  // the room's floor is then water
  record.path = [](double t) {
    return core::isometryFromXyzYpr(0.3 * std::sin(t), 0, 0.8, 0, 0.05 * std::sin(2 * t), 0.1);
  };
  record.duration_s = 3;
  const Replay run = replay(record);
  const auto& last = run.results.back();
  EXPECT_GT(last.belowWaterCount, 100U);
  const core::Isometry truth = record.path(core::secondsBetween(timeOf(0), last.time));
  for (const auto& p : last.points_vehicle)
    EXPECT_GT((truth.linear() * p.cast<double>()).z(), -1.5 + 0.3 - 0.1);  // 5 mrad of tilt over 15 m
}

}  // namespace
}  // namespace s2s::odometry
