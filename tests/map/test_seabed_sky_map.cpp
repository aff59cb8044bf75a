#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "map_points.h"

namespace {

using namespace s2s::map;
using s2s::core::durationNs;
using s2s::core::Isometry;
using s2s::core::isometryFromXyzYpr;
using s2s::test::keepAll;
using s2s::test::pointsOf;

TEST(CSeabedSkyMap, InsertedScan_ComesBackAtItsPlaceWithAllItCarries) {
  CSeabedSkyMap map(keepAll());
  map.addKeyframe({1, 0, Isometry::Identity(), isometryFromXyzYpr(10, 20, 30, 0.5, 0, 0)});
  const Isometry T_odom_vehicle = isometryFromXyzYpr(1, 2, 0.5, 0.1, 0.02, 0.03);
  EXPECT_EQ(map.insertScan(Layer::Stereo, 123, T_odom_vehicle, {{{1, 2, -3}, 200, 0.05f}}), 1u);
  const auto points = pointsOf(map, Layer::Stereo);
  ASSERT_EQ(points.size(), 1u);
  const Eigen::Vector3d expected =
      isometryFromXyzYpr(10, 20, 30, 0.5, 0, 0) * T_odom_vehicle * Eigen::Vector3d(1, 2, -3);
  EXPECT_LT((points[0].p_map - expected).norm(), 1e-12);
  EXPECT_EQ(points[0].time, 123);
  EXPECT_EQ(points[0].intensity, 200);
  EXPECT_EQ(points[0].layer, Layer::Stereo);
  EXPECT_NEAR(points[0].sigma_m, 0.05, 0.05 / 2048);  // half float
  EXPECT_EQ(map.pointCount(Layer::Lidar), 0u);
}

TEST(CSeabedSkyMap, GraphUpdate_MovesPointsExactly) {
  CSeabedSkyMap map(keepAll());
  std::vector<ScanPoint> cloud;
  for (int i = 0; i < 50; ++i) cloud.push_back({{0.3f * static_cast<float>(i), 1, 2}, 1, 0.02f});
  for (std::uint64_t id = 0; id < 3; ++id) {
    const Isometry T = isometryFromXyzYpr(static_cast<double>(id), 0, 0, 0, 0, 0);
    map.addKeyframe({id, durationNs(static_cast<double>(id)), T, T});
  }
  const Isometry T_odom = isometryFromXyzYpr(1.25, 0, 0, 0, 0, 0);
  map.insertScan(Layer::Lidar, durationNs(1.25), T_odom, cloud);
  const auto before = pointsOf(map, Layer::Lidar);
  const Isometry T_moved = isometryFromXyzYpr(-3, 4, 0.2, 0.3, -0.1, 0.05);
  std::map<std::uint64_t, Isometry> poses;
  for (const Keyframe& keyframe : map.keyframes()) poses[keyframe.id] = T_moved * keyframe.T_map_vehicle;
  EXPECT_EQ(map.setKeyframePoses(poses), 3u);
  const auto after = pointsOf(map, Layer::Lidar);
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < after.size(); ++i)
    EXPECT_LT((after[i].p_map - T_moved * before[i].p_map).norm(), 1e-12);  // rounding in double
}

TEST(CSeabedSkyMap, OneKeyframeMoved_MovesOnlyWhatLiesBesideIt) {
  CSeabedSkyMap map(keepAll());
  for (std::uint64_t id = 0; id < 4; ++id)
    map.addKeyframe({id, durationNs(static_cast<double>(id)), Isometry::Identity(), Isometry::Identity()});
  for (const double t : {0.5, 1.5, 2.5})
    map.insertScan(Layer::Stereo, durationNs(t), Isometry::Identity(), {{{1, 0, 0}, 0, 0}});
  map.setKeyframePoses({{0, isometryFromXyzYpr(0, 0, 1, 0, 0, 0)}});
  const auto points = pointsOf(map, Layer::Stereo);
  EXPECT_NEAR(points[0].p_map.z(), 0.5, 1e-12);
  EXPECT_EQ(points[1].p_map.z(), 0);
  EXPECT_EQ(points[2].p_map.z(), 0);
}

TEST(CSeabedSkyMap, KeyframeThatComesAfterItsScan_CountsAllTheSame) {
  CSeabedSkyMap map(keepAll());
  map.addKeyframe({0, 0, Isometry::Identity(), Isometry::Identity()});
  map.insertScan(Layer::Stereo, durationNs(0.5), Isometry::Identity(), {{{0, 0, 0}, 0, 0}});
  map.addKeyframe({1, durationNs(1), Isometry::Identity(), isometryFromXyzYpr(2, 0, 0, 0, 0, 0)});
  EXPECT_NEAR(pointsOf(map, Layer::Stereo)[0].p_map.x(), 1, 1e-12);
}

TEST(CSeabedSkyMap, NotFinitePoints_AreDropped) {
  CSeabedSkyMap map(keepAll());
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(map.insertScan(Layer::Stereo, 0, Isometry::Identity(), {{{nan, 0, 0}, 0, 0}}), 0u);
  LineScan line;
  line.verticalAperture_rad = 0.35;
  line.returns = {{nan, 0, 0, 0}, {5, nan, 0, 0}, {-1, 0, 0, 0}, {5, 0, 9, 0.01f}};
  EXPECT_EQ(map.insertLineScan(Layer::LineHorizontal, 0, Isometry::Identity(), line), 1u);
  EXPECT_EQ(map.pointCount(), 1u);
}

TEST(CSeabedSkyMap, LidarOutsideItsRangeGate_StaysOut) {
  CSeabedSkyMap map;
  EXPECT_EQ(map.insertScan(Layer::Lidar, 0, Isometry::Identity(),
                           {{{0.1f, 0, 0}, 0, 0}, {{300, 0, 0}, 0, 0}, {{10, 0, 0}, 0, 0}}),
            1u);
}

TEST(CSeabedSkyMap, RepeatedSweeps_AreThinnedToTheVoxel) {
  CSeabedSkyMap map;
  std::vector<ScanPoint> wall;
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j < 40; ++j)
      wall.push_back({{5.0f, 0.0251f * static_cast<float>(i), 0.0251f * static_cast<float>(j)}, 1, 0});
  for (int sweep = 0; sweep < 20; ++sweep)
    map.insertScan(Layer::Lidar, durationNs(0.1 * sweep), Isometry::Identity(), wall);
  // 1 m x 1 m in voxels of 0.1 m, with the border ones that its last points reach: 10 x 10.
  EXPECT_EQ(map.pointCount(Layer::Lidar), 100u);
}

TEST(CSeabedSkyMap, TenMillionPoints_TakeSixteenBytesEach) {
  std::vector<ScanPoint> sweep(100000);
  for (std::size_t i = 0; i < sweep.size(); ++i) sweep[i].p_vehicle.x() = static_cast<float>(i);
  MapOptions options = keepAll();
  options.insertion.lidarMaxRange_m = 1e9;
  CSeabedSkyMap map(options);
  for (int i = 0; i < 100; ++i) map.insertScan(Layer::Lidar, i, Isometry::Identity(), sweep);
  ASSERT_EQ(map.pointCount(), 10'000'000u);
  // Packed points are 16 bytes; the scan's own record, some 200 bytes, is shared by its 100 000 points.
  EXPECT_LT(static_cast<double>(map.memory_bytes()) / 1e7, 16.1);
}

TEST(CSeabedSkyMap, BoundingBox_IsThatOfThePoints) {
  CSeabedSkyMap map(keepAll());
  EXPECT_FALSE(map.boundingBox());
  map.insertScan(Layer::Lidar, 0, Isometry::Identity(), {{{1, 2, 3}, 0, 0}, {{-1, 5, 0}, 0, 0}});
  map.insertScan(Layer::Stereo, 0, Isometry::Identity(), {{{0, 0, -9}, 0, 0}});
  const auto box = map.boundingBox();
  ASSERT_TRUE(box);
  EXPECT_EQ(box->min, mrpt::math::TPoint3D(-1, 0, -9));
  EXPECT_EQ(box->max, mrpt::math::TPoint3D(1, 5, 3));
  EXPECT_EQ(map.boundingBox(Layer::Lidar)->min.z, 0);
}

TEST(CSeabedSkyMap, Copy_IsDeep) {
  CSeabedSkyMap map(keepAll());
  map.addKeyframe({0, 0, Isometry::Identity(), Isometry::Identity()});
  map.insertScan(Layer::Stereo, 0, Isometry::Identity(), {{{1, 0, 0}, 0, 0}});
  CSeabedSkyMap copy(map);
  map.setKeyframePoses({{0, isometryFromXyzYpr(5, 0, 0, 0, 0, 0)}});
  map.insertScan(Layer::Stereo, 0, Isometry::Identity(), {{{2, 0, 0}, 0, 0}});
  ASSERT_EQ(copy.pointCount(), 1u);
  EXPECT_EQ(pointsOf(copy, Layer::Stereo)[0].p_map.x(), 1);
}

TEST(CSeabedSkyMap, Clear_LeavesNothing) {
  CSeabedSkyMap map(keepAll());
  map.addKeyframe({0, 0, Isometry::Identity(), Isometry::Identity()});
  map.insertScan(Layer::Lidar, 0, Isometry::Identity(), {{{1, 0, 0}, 0, 0}});
  map.clear();
  EXPECT_TRUE(map.isEmpty());
  EXPECT_TRUE(map.keyframes().empty());
  EXPECT_FALSE(map.boundingBox());
}

}  // namespace
