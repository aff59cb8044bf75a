#include <gtest/gtest.h>
#include <mrpt/maps/CPointsMapXYZI.h>

#include "s2s/core/error.h"
#include "s2s/odometry/deskew.h"
#include "synthetic.h"

namespace s2s::odometry {
namespace {

using namespace synthetic;
using Eigen::Vector3d;

/// A lively motion: 1 rad/s and metres a second.
Path livelyPath() {
  return [](double t) {
    return core::isometryFromXyzYpr(2 * std::sin(t), std::sin(1.4 * t), 1 + 0.2 * std::sin(2 * t),
                                    0.7 * std::sin(1.5 * t), 0.1 * std::sin(2.2 * t), 0.2 * std::sin(1.8 * t));
  };
}

core::Trajectory trajectoryOf(const Path& path, double from, double to) {
  core::Trajectory trajectory;
  for (int i = 0; from + 0.001 * i <= to + 1e-9; ++i)
    trajectory.append(timeOf(from + 0.001 * i), path(from + 0.001 * i));
  return trajectory;
}

/// Distance of a point from the nearest of the room's surfaces.
double distanceToSurface(const World& world, const Vector3d& p) {
  double nearest = 1e9;
  for (const auto& box : world.boxes) {
    const Eigen::Array3d outside = (box.min.array() - p.array()).max(p.array() - box.max.array());
    const double d = (outside <= 0).all() ? -outside.maxCoeff() : outside.max(0).matrix().norm();
    nearest = std::min(nearest, d);
  }
  return nearest;
}

TEST(DeskewSweep, TruePath_PutsEveryPointOnASurface) {
  Random random(1);
  Lidar lidar;
  lidar.rangeSigma_m = 0;
  const World world = room();
  const auto sweep = sweepAt(world, livelyPath(), 0.5, lidar, random);
  const core::TimeNs reference = timeOf(0.57);
  const auto cloud = deskewSweep(sweep, trajectoryOf(livelyPath(), 0.4, 0.7), reference, {});
  ASSERT_EQ(cloud.points_vehicle.size(), sweep.returnCount());
  ASSERT_EQ(cloud.sigma_m.size(), cloud.points_vehicle.size());
  EXPECT_EQ(cloud.time, reference);
  for (std::size_t i = 0; i < cloud.points_vehicle.size(); ++i) {
    // Ranges count in millimetres, trajectory poses are 1 ms apart.
    EXPECT_LT(distanceToSurface(world, livelyPath()(0.57) * cloud.points_vehicle[i].cast<double>()), 0.002);
    EXPECT_EQ(cloud.reflectivity[i], 7.0F);
    EXPECT_GE(cloud.sigma_m[i], 0.02F);
  }
}

TEST(DeskewSweep, ColumnsOutsideTheTrajectory_AreCountedAndLeftOut) {
  Random random(1);
  const auto sweep = sweepAt(room(), livelyPath(), 0.5, {}, random);
  const auto cloud = deskewSweep(sweep, trajectoryOf(livelyPath(), 0.4, 0.55), timeOf(0.5), {});
  EXPECT_EQ(cloud.points_vehicle.size() + cloud.withoutPoseCount, sweep.returnCount());
  EXPECT_NEAR(static_cast<double>(cloud.withoutPoseCount) / static_cast<double>(sweep.returnCount()), 0.5, 0.02);
}

TEST(DeskewSweep, ReferenceOutsideTheTrajectory_GivesNothing) {
  Random random(1);
  const auto sweep = sweepAt(room(), livelyPath(), 0.5, {}, random);
  EXPECT_TRUE(deskewSweep(sweep, trajectoryOf(livelyPath(), 0.4, 0.7), timeOf(2), {}).points_vehicle.empty());
}

TEST(DeskewSweep, LowestHeight_FollowsTheVesselsAttitude) {
  Random random(1);
  const auto sweep = sweepAt(room(), livelyPath(), 0.5, {}, random);
  DeskewOptions options;
  options.lowestHeight_m = 0.2;
  const auto cloud = deskewSweep(sweep, trajectoryOf(livelyPath(), 0.4, 0.7), timeOf(0.55), options);
  EXPECT_GT(cloud.belowWaterCount, 100U);
  EXPECT_EQ(cloud.belowWaterCount + cloud.points_vehicle.size(), sweep.returnCount());
  for (const auto& p : cloud.points_vehicle) EXPECT_GE((livelyPath()(0.55) * p.cast<double>()).z(), 0.2 - 1e-4);
}

TEST(DeskewSweep, OwnHull_IsLeftOut) {
  Random random(1);
  const auto sweep = sweepAt(room(), livelyPath(), 0.5, {}, random);
  DeskewOptions options;
  options.filter.hullBox = {-9, -5, -3, 9, 5, 3};
  const auto cloud = deskewSweep(sweep, trajectoryOf(livelyPath(), 0.4, 0.7), timeOf(0.5), options);
  EXPECT_GT(cloud.ownHullCount, 100U);
  EXPECT_EQ(cloud.ownHullCount + cloud.points_vehicle.size(), sweep.returnCount());
  options.filter.hullBox = {1, 2, 3};
  EXPECT_THROW(deskewSweep(sweep, trajectoryOf(livelyPath(), 0.4, 0.7), timeOf(0.5), options), core::ConfigError);
}

TEST(DeskewCloud, CloudWithoutTimes_MovesAsAWhole) {
  auto points = mrpt::maps::CPointsMapXYZI::Create();
  points->insertPointFast(5, 1, 0.5);
  points->setPointIntensity(0, 0.25F);
  points->insertPointFast(0.1F, 0, 0);  // too near
  mrpt::obs::CObservationPointCloud observation;
  observation.pointcloud = points;
  observation.timestamp = core::toMrptTime(timeOf(0.5));
  observation.sensorPose = core::toPose(core::isometryFromXyzYpr(0.2, 0, 1, 0.1, 0, 0));
  const auto cloud = deskewCloud(observation, trajectoryOf(livelyPath(), 0.4, 0.7), timeOf(0.6), {});
  ASSERT_EQ(cloud.points_vehicle.size(), 1U);
  const Vector3d expected = livelyPath()(0.6).inverse() * livelyPath()(0.5) *
                            core::isometryFromXyzYpr(0.2, 0, 1, 0.1, 0, 0) * Vector3d(5, 1, 0.5);
  EXPECT_LT((cloud.points_vehicle[0].cast<double>() - expected).norm(), 1e-4);
  EXPECT_FLOAT_EQ(cloud.reflectivity[0], 0.25F);
  EXPECT_EQ(cloud.outOfRangeCount, 1U);
}

}  // namespace
}  // namespace s2s::odometry
