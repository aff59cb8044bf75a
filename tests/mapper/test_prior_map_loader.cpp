#include <gtest/gtest.h>

#include "s2s/core/error.h"
#include "s2s/mapper/prior_map_loader.h"
#include "s2s/products/ply_writer.h"
#include "s2s/products/trajectory_files.h"
#include "temp_folder.h"

namespace s2s::mapper {
namespace {

constexpr core::TimeNs kStart = 1'733'400'000'123'456'789;

core::Trajectory keyframes() {
  core::Trajectory poses;
  for (int k = 0; k < 3; ++k)
    poses.append(kStart + core::durationNs(k), core::isometryFromXyzYpr(10.0 * k, 5, 0.1, 0.5 * k, 0.01, -0.02));
  return poses;
}

/// A wall of points seen from each keyframe.
/// 10 m x 5 m, 8 m ahead.
graph::Cloud wall() {
  graph::Cloud points;
  for (int column = 0; column < 20; ++column)
    for (int row = 0; row < 10; ++row)
      points.emplace_back(8, 0.5F * static_cast<float>(column), 0.5F * static_cast<float>(row));
  return points;
}

void writeCloud(const std::string& path, core::TimeNs shift) {
  products::PlyPointWriter writer(path);
  const core::Trajectory from = keyframes();
  for (const auto& pose : from.poses())
    for (const Eigen::Vector3f& p_vehicle : wall()) {
      map::MapPoint point;
      point.p_map = pose.T * p_vehicle.cast<double>();
      point.time = pose.time + shift;
      writer.add(point);
    }
  writer.finish();
}

TEST(PriorMapLoader, MapOfARun_ComesBackAsKeyframesWithClouds) {
  const test::TempFolder folder;
  products::writeTum(folder.file("keyframes.tum"), keyframes());
  writeCloud(folder.file("lidar.ply"), 0);
  const auto prior = loadPriorMap(folder.path(), {});
  EXPECT_EQ(prior->size(), 3U);
  EXPECT_NEAR(prior->distanceTo_m({20, 5, 0.1}), 0, 1e-6);
  // The middle keyframe's wall registers where it was seen from.
  const core::Trajectory from = keyframes();
  const auto fix = prior->registerAt(from.poses()[1].T, wall());
  EXPECT_GT(fix.overlap, 0.9);
  EXPECT_LT(fix.rmse_m, 1e-3);
}

TEST(PriorMapLoader, MissingFolder_IsRefusedByName) {
  try {
    loadPriorMap("/no/such/map", {});
    FAIL() << "no error";
  } catch (const core::InputError& error) {
    EXPECT_NE(error.where().find("/no/such/map"), std::string::npos);
  }
}

TEST(PriorMapLoader, PointsOfOtherTimes_AreNoMap) {
  const test::TempFolder folder;
  products::writeTum(folder.file("keyframes.tum"), keyframes());
  writeCloud(folder.file("lidar.ply"), core::durationNs(0.4));
  EXPECT_THROW(loadPriorMap(folder.path(), {}), core::InputError);
}

}  // namespace
}  // namespace s2s::mapper
