#include <gtest/gtest.h>

#include <iostream>

#include "s2s/odometry/lidar_inertial_odometry.h"
#include "synthetic.h"

namespace s2s::odometry {
namespace {

using namespace synthetic;

struct Run {
  std::vector<OdometryResult> results;
  core::Trajectory trajectory;
  OdometryFaults faults;
};

struct Setup {
  World world = room();
  Path path = roomPath();
  Lidar lidar;
  core::Isometry T_vehicle_imu = core::isometryFromXyzYpr(0.1, -0.05, 0.85, 0.3, 0.05, -0.1);
  ImuNoise noise{0.002, 0.02, {0.004, -0.003, 0.002}, {0.03, -0.02, 0.01}};
  double duration_s = 12;
  bool hasImu = true;
  bool hasPointTimes = true;
  OdometryOptions options;
  std::uint64_t seed = 1;
};

Run runOdometry(const Setup& setup) {
  Random random(setup.seed);
  LidarInertialOdometry odometry(setup.options);
  Run run;
  const auto drain = [&] {
    while (auto result = odometry.next()) run.results.push_back(std::move(*result));
  };
  int imuCount = 0;
  for (double t = 0; t < setup.duration_s; t += setup.lidar.period_s) {
    for (; setup.hasImu && 0.01 * imuCount < t; ++imuCount)
      odometry.addImu(imuAt(setup.path, 0.01 * imuCount, setup.T_vehicle_imu, setup.noise, random));
    Scan scan = scanAt(setup.world, setup.path, t, setup.lidar, random);
    if (!setup.hasPointTimes) scan.offset_s.clear();
    odometry.addScan(std::move(scan));
    drain();
  }
  odometry.finish();
  drain();
  run.trajectory = odometry.trajectory();
  run.faults = odometry.faults();
  return run;
}

/// Error of the motion since the first result.
core::Isometry errorAt(const Run& run, const Setup& setup, std::size_t i) {
  const auto truth = [&](const OdometryResult& result) {
    return setup.path(core::secondsBetween(timeOf(0), result.time));
  };
  const core::Isometry ours = run.results.front().T_odom_vehicle.inverse() * run.results[i].T_odom_vehicle;
  return (truth(run.results.front()).inverse() * truth(run.results[i])).inverse() * ours;
}

struct Worst {
  double translation_m = 0, rotation_rad = 0;
};
Worst worstError(const Run& run, const Setup& setup) {
  Worst worst;
  for (std::size_t i = 0; i < run.results.size(); ++i) {
    const auto error = errorAt(run, setup, i);
    worst.translation_m = std::max(worst.translation_m, error.translation().norm());
    worst.rotation_rad = std::max(worst.rotation_rad, core::logSo3(error.linear()).norm());
  }
  return worst;
}

TEST(Odometry, RoomWithImu_FollowsTheTruth) {
  const Setup setup;
  const Run run = runOdometry(setup);
  ASSERT_EQ(run.results.size(), 120U);
  const Worst worst = worstError(run, setup);
  std::cout << "worst " << worst.translation_m << " m " << worst.rotation_rad << " rad\n";
  const auto& last = run.results.back();
  std::cout << "bias " << last.gyroBias_radps.transpose() << " acc " << last.accelBias_mps2.transpose() << " up "
            << last.up_odom.transpose() << " sigma " << last.gravitySigma_rad << " it " << last.iterations << " match "
            << last.matchCount << "/" << last.pointCount << " scale " << last.residualScale << "\n";
  EXPECT_LT(worst.translation_m, 0.02);
  EXPECT_LT(worst.rotation_rad, 0.002);
}

TEST(Odometry, RoomWithoutImu_FollowsTheTruth) {
  Setup setup;
  setup.hasImu = false;
  const Run run = runOdometry(setup);
  ASSERT_EQ(run.results.size(), 120U);
  const Worst worst = worstError(run, setup);
  std::cout << "worst " << worst.translation_m << " m " << worst.rotation_rad << " rad\n";
  EXPECT_LT(worst.translation_m, 0.03);
  EXPECT_LT(worst.rotation_rad, 0.003);
}

TEST(Odometry, CanalWithImu_DriftsLittle) {
  Setup setup;
  setup.world = canal();
  setup.path = cruise(1.3, 0, 0);
  setup.duration_s = 80;
  setup.lidar.rows = 64;
  setup.lidar.columns = 512;
  const Run run = runOdometry(setup);
  const auto error = errorAt(run, setup, run.results.size() - 1);
  std::cout << "end error " << error.translation().transpose() << " m " << core::logSo3(error.linear()).transpose()
            << " rad\n";
  EXPECT_LT(error.translation().norm(), 0.2);
}

}  // namespace
}  // namespace s2s::odometry
