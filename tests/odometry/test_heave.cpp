#include <gtest/gtest.h>

#include "replay.h"
#include "s2s/odometry/heave_fit.h"

namespace s2s::odometry {
namespace {

using namespace synthetic;
using Eigen::Vector3d;

/// The vessel lies still between bare walls and heaves, rolls and pitches on waves of two periods.
Record heavingStart(double phase) {
  Record record;
  record.world.boxes = {{{-20, -8, -1e4}, {30, 9, 1e4}}};
  record.path = [phase](double t) {
    return core::isometryFromXyzYpr(0, 0, 0.03 * std::sin(3.3 * t + phase) + 0.015 * std::sin(2.3 * t + 2 * phase), 0.2,
                                    0.03 * std::sin(3.1 * t + phase), 0.03 * std::sin(3.7 * t + 3 * phase));
  };
  return record;
}

double worstHeight(const Replay& run, const Record& record, double from_s, double to_s) {
  double worst = 0;
  for (std::size_t i = 0; i < run.results.size(); ++i) {
    const double t = core::secondsBetween(timeOf(0), run.results[i].time);
    const core::Isometry truth = record.path(t);
    const double up = (truth.linear() * errorAt(run, record, i).translation()).z();
    if (t >= from_s && t < to_s) worst = std::max(worst, std::abs(up));
  }
  return worst;
}

TEST(Odometry, HeavingStartBetweenBareWalls_HeightIsRightFromTheFirstPoses) {
  for (const double phase : {0.0, 2.0}) {
    Record record = heavingStart(phase);
    const Replay run = replay(record);
    // No surface tells the height. The heave's r.m.s. is 2.4 cm: to know nothing but its mean would be off by 4 cm.
    EXPECT_LT(worstHeight(run, record, 0, 12), 0.03) << phase;
    record.options.water.heavePrior = false;
    // Without that knowledge a speed that is off by some centimetres a second stays.
    EXPECT_GT(worstHeight(replay(record), record, 3, 12), 0.1) << phase;
  }
}

TEST(Odometry, FloatingWithoutImuBetweenBareWalls_HoldsItsHeight) {
  for (const double phase : {0.0, 1.0, 2.0}) {
    Record record;
    record.hasImu = false;
    record.duration_s = 25;
    record.world.boxes = {{{-30, -9, -1e4}, {80, 8, 1e4}}};
    for (int i = 0; i < 8; ++i) {
      const double x = 8.0 * i, y = i % 2 ? 6.0 : -8.0;
      record.world.boxes.push_back({{x, y, -1e4}, {x + 1.5, y + 1.5, 1e4}});
    }
    record.path = [phase](double t) {
      return core::isometryFromXyzYpr(1.2 * t, 0.3 * std::sin(0.3 * t), 0.02 * std::sin(2.1 * t + phase),
                                      0.1 * std::sin(0.2 * t), 0.02 * std::sin(1.7 * t + phase),
                                      0.03 * std::sin(1.9 * t + 2 * phase));
    };
    // The heaves are 2 cm; the first frame leans by up to 2 degrees, which is worth 1 m after 30 m and has to be found.
    EXPECT_LT(worstHeight(replay(record), record, 0, 25), 0.15) << phase;
    record.options.water.heavePrior = false;
    EXPECT_GT(worstHeight(replay(record), record, 0, 25), 0.5) << phase;
  }
}

TEST(HeaveFit, RegularWaves_GiveSpeedHeightAndAccelerationError) {
  for (const double phase : {0.0, 1.5, 3.0}) {
    const auto height = [phase](double t) { return 0.04 * std::sin(3.3 * t + phase); };
    const Path path = [&](double t) { return core::isometryFromXyzYpr(0, 0, height(t), 0, 0, 0); };
    const core::Isometry T_vehicle_imu = core::Isometry::Identity();
    const ImuNoise noise{0, 0, Vector3d::Zero(), {0, 0, 0.05}};
    Random random(1);
    ImuBuffer imu;
    for (int i = 0; i <= 600; ++i) imu.add(imuAt(path, 0.01 * i, T_vehicle_imu, noise, random));
    NavState start;
    start.time = timeOf(0);
    start.gravity = {0, 0, -9.81};
    const HeaveFit fit = fitHeave(start, T_vehicle_imu, imu, timeOf(6), OdometryOptions());
    // The wave's period is tried in steps of 8 %, and prior knowledge pulls all unknowns to zero a little.
    EXPECT_NEAR(fit.speed_mps, 0.04 * 3.3 * std::cos(phase), 0.01);
    EXPECT_NEAR(fit.floatingHeight_m, -height(0), 0.01);
    EXPECT_NEAR(fit.acceleration_mps2, -0.05, 0.01);
    EXPECT_NEAR(fit.heaveSigma_m, 0.04 / std::sqrt(2.0), 0.01);
  }
}

}  // namespace
}  // namespace s2s::odometry
