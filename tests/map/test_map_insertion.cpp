#include <gtest/gtest.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <random>

#include "lidar_scene.h"
#include "map_points.h"
#include "s2s/map/sonar_scans.h"
#include "s2s/obs/CObservationImagingSonar.h"
#include "s2s/sonar/ping_geometry.h"

namespace {

using namespace s2s::map;
using s2s::core::Isometry;
using s2s::core::isometryFromXyzYpr;
using s2s::core::toPose;
using s2s::test::keepAll;
using s2s::test::pointsOf;

const Isometry kRobot = isometryFromXyzYpr(2, -1, 0.5, 0.3, 0.05, -0.02);
const Isometry kSensor = isometryFromXyzYpr(0.4, 0.1, 1.2, 0.1, 0, 0);

TEST(MapInsertion, LidarSweep_PointsLieOnTheRoom) {
  CSeabedSkyMap map(keepAll());
  const auto sweep = s2s::test::sweepInRoom(kRobot, kSensor);
  ASSERT_TRUE(map.insertObservation(*sweep, toPose(kRobot)));
  EXPECT_EQ(map.pointCount(Layer::Lidar), sweep->returnCount());
  for (const MapPoint& p : pointsOf(map, Layer::Lidar)) {
    const double toBox = std::min({std::abs(std::abs(p.p_map.x()) - 10), std::abs(std::abs(p.p_map.y()) - 6),
                                   std::abs(p.p_map.z() + 2), std::abs(p.p_map.z() - 6)});
    const double toPillar = std::abs((p.p_map.head<2>() - Eigen::Vector2d(4, 3)).norm() - 0.5);
    EXPECT_LT(std::min(toBox, toPillar), 0.001);  // ranges are in millimetres
    EXPECT_GE(p.intensity, 100);
    EXPECT_LT(p.intensity, 132);
    EXPECT_EQ(p.time, 1'733'400'000'000'000'000);
    EXPECT_GT(p.sigma_m, 0);
  }
}

TEST(MapInsertion, InvalidColumnsAndMissingReturns_AreLeftOut) {
  CSeabedSkyMap map(keepAll());
  const auto sweep = s2s::test::sweepInRoom(kRobot, kSensor);
  sweep->columnValid.assign(256, 1);
  sweep->columnValid[5] = 0;
  sweep->echoes[0].range[0] = 0;
  map.insertObservation(*sweep, toPose(kRobot));
  EXPECT_EQ(map.pointCount(), 32u * 255u - 1u);
}

TEST(MapInsertion, PointCloud_IsPlacedBySensorPoseAndKeepsIntensity) {
  CSeabedSkyMap map(keepAll());
  mrpt::obs::CObservationPointCloud cloud;
  auto points = mrpt::maps::CPointsMapXYZI::Create();
  points->insertPointRGB(1, 2, 3, 0.25f, 0, 0);
  cloud.pointcloud = points;
  cloud.sensorPose = toPose(kSensor);
  ASSERT_TRUE(map.insertObservation(cloud, toPose(kRobot)));
  const auto stored = pointsOf(map, Layer::Lidar);
  ASSERT_EQ(stored.size(), 1u);
  EXPECT_LT((stored[0].p_map - kRobot * kSensor * Eigen::Vector3d(1, 2, 3)).norm(), 1e-6);  // single precision
  EXPECT_EQ(stored[0].intensity, 0.25f);
}

TEST(MapInsertion, PointCloudWithoutIntensityOrPose_IsTaken) {
  CSeabedSkyMap map(keepAll());
  mrpt::obs::CObservationPointCloud cloud;
  auto points = mrpt::maps::CSimplePointsMap::Create();
  points->insertPoint(1, 2, 3);
  cloud.pointcloud = points;
  ASSERT_TRUE(map.insertObservation(cloud));
  EXPECT_LT((pointsOf(map, Layer::Lidar).at(0).p_map - Eigen::Vector3d(1, 2, 3)).norm(), 1e-6);
}

TEST(MapInsertion, PlanarScan_IsTakenThroughMrpt) {
  CSeabedSkyMap map(keepAll());
  mrpt::obs::CObservation2DRangeScan scan;
  scan.aperture = static_cast<float>(M_PI);
  scan.maxRange = 80;
  scan.resizeScan(3);
  for (std::size_t i = 0; i < 3; ++i) {
    scan.setScanRange(i, 5);
    scan.setScanRangeValidity(i, true);
  }
  scan.sensorPose = toPose(kSensor);
  ASSERT_TRUE(map.insertObservation(scan, toPose(kRobot)));
  ASSERT_EQ(map.pointCount(), 3u);
  EXPECT_LT((pointsOf(map, Layer::Lidar)[1].p_map - kRobot * kSensor * Eigen::Vector3d(5, 0, 0)).norm(), 1e-4);
}

TEST(MapInsertion, DepthCamera_IsTakenThroughMrpt) {
  CSeabedSkyMap map(keepAll());
  mrpt::obs::CObservation3DRangeScan scan;
  scan.hasPoints3D = true;
  scan.resizePoints3DVectors(2);
  scan.points3D_x = {4, 5};
  scan.points3D_y = {1, 2};
  scan.points3D_z = {0.5f, 0.6f};
  scan.sensorPose = toPose(kSensor);
  ASSERT_TRUE(map.insertObservation(scan, toPose(kRobot)));
  ASSERT_EQ(map.pointCount(), 2u);
  EXPECT_LT((pointsOf(map, Layer::Lidar)[0].p_map - kRobot * kSensor * Eigen::Vector3d(4, 1, 0.5)).norm(), 1e-4);
}

TEST(MapInsertion, VelodyneCloud_IsTakenThroughMrpt) {
  CSeabedSkyMap map(keepAll());
  mrpt::obs::CObservationVelodyneScan scan;
  scan.point_cloud.x = {6};
  scan.point_cloud.y = {1};
  scan.point_cloud.z = {2};
  scan.point_cloud.intensity = {9};
  scan.sensorPose = toPose(kSensor);
  ASSERT_TRUE(map.insertObservation(scan, toPose(kRobot)));
  EXPECT_LT((pointsOf(map, Layer::Lidar).at(0).p_map - kRobot * kSensor * Eigen::Vector3d(6, 1, 2)).norm(), 1e-4);
}

/// A ping with one bright spot of three beams by five bins, in front of it nothing.
s2s::obs::CObservationImagingSonar spotPing(const Isometry& T_vehicle_sonar, std::uint32_t beam, std::uint32_t bin) {
  s2s::obs::CObservationImagingSonar ping;
  ping.sensorLabel = "SONAR";
  ping.timestamp = s2s::core::toMrptTime(1'733'400'000'000'000'000);
  ping.sensorPose = toPose(T_vehicle_sonar);
  ping.beamCount = 64;
  ping.rangeCount = 400;
  for (int i = 0; i < 64; ++i) ping.bearings_rad.push_back(static_cast<float>((i - 31.5) * 0.01));
  ping.rangeResolution_m = 0.02;
  ping.verticalAperture_rad = 20 * M_PI / 180;
  ping.samples.assign(64 * 400, 5);
  for (std::uint32_t b = bin; b < bin + 5; ++b)
    for (std::uint32_t i = beam - 1; i <= beam + 1; ++i) ping.samples[b * 64 + i] = 250;
  return ping;
}

const Isometry kHorizontal = isometryFromXyzYpr(0, 0, -0.4, 0, M_PI / 4, 0);
const Isometry kVertical = isometryFromXyzYpr(0, 0, -0.4, 0, M_PI / 4, M_PI / 2);

TEST(MapInsertion, SonarPings_BecomeLineScansByTheirMounting) {
  for (const bool isVertical : {false, true}) {
    CSeabedSkyMap map;
    const Isometry& T_vehicle_sonar = isVertical ? kVertical : kHorizontal;
    const Layer layer = isVertical ? Layer::LineVertical : Layer::LineHorizontal;
    ASSERT_TRUE(map.insertObservation(spotPing(T_vehicle_sonar, 20, 200), toPose(kRobot)));
    EXPECT_EQ(map.pointCount(), map.pointCount(layer));
    ASSERT_EQ(map.pointCount(layer), 3u);
    map.forEachPoint(layer, [&](const MapPoint& p) {
      const Eigen::Vector3d p_sonar = (kRobot * T_vehicle_sonar).inverse() * p.p_map;
      EXPECT_NEAR(p_sonar.norm(), 4.02,
                  0.021);  // known to a bin, and the vertical sonar's median filter takes a corner off
      EXPECT_NEAR(std::atan2(p_sonar.y(), p_sonar.x()), (20 - 31.5) * 0.01, 0.0101);  // one of three beams
    });
  }
}

TEST(MapInsertion, RollTellsTheSonarsApart_WhateverWayTheyLook) {
  const double pitch = M_PI / 4;
  for (const double yaw : {-3.0, -M_PI / 2, -0.7, 0.0, 0.7, M_PI / 2, 3.0}) {
    EXPECT_FALSE(isVerticalSonar(isometryFromXyzYpr(0, 0, 0, yaw, pitch, 0))) << yaw;
    EXPECT_FALSE(isVerticalSonar(isometryFromXyzYpr(0, 0, 0, yaw, pitch, M_PI))) << yaw;  // upside down
    EXPECT_TRUE(isVerticalSonar(isometryFromXyzYpr(0, 0, 0, yaw, pitch, M_PI / 2))) << yaw;
  }
  // Straight down there is no roll: the fan of the horizontal one lies across the vessel.
  EXPECT_FALSE(isVerticalSonar(isometryFromXyzYpr(0, 0, 0, 0, M_PI / 2, 0)));
  EXPECT_TRUE(isVerticalSonar(isometryFromXyzYpr(0, 0, 0, 0, M_PI / 2, M_PI / 2)));
}

/// Rubble within 0.2 m of a place, painted into a ping of the sonar; the same rubble for every sonar.
void paintRubble(s2s::obs::CObservationImagingSonar& ping, const Isometry& T_vehicle_sonar,
                 const Eigen::Vector3d& centre_vehicle) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> offset(-0.12, 0.12);
  for (int i = 0; i < 150; ++i) {
    const Eigen::Vector3d p_vehicle = centre_vehicle + Eigen::Vector3d(offset(random), offset(random), offset(random));
    const auto echo = static_cast<std::uint8_t>(160 + random() % 90);
    const auto c = s2s::sonar::sonarCoordinates(T_vehicle_sonar.inverse() * p_vehicle, ping.bearingModel);
    const auto beam = static_cast<std::size_t>(std::lround(c.bearing_rad / 0.01 + 31.5));
    const auto bin = static_cast<std::size_t>(c.range_m / ping.rangeResolution_m);
    for (std::size_t b = bin - 1; b <= bin + 1; ++b)
      for (std::size_t k = beam - 1; k <= beam + 1; ++k)
        ping.samples[b * 64 + k] = std::max(ping.samples[b * 64 + k], echo);
  }
}

TEST(MapInsertion, PingsOfBothSonarsCloseInTime_GiveStereoPoints) {
  const Eigen::Vector3d rubble = kHorizontal * Eigen::Vector3d(4.5, 0.1, -0.1);
  auto h = spotPing(kHorizontal, 10, 380), v = spotPing(kVertical, 10, 380);
  paintRubble(h, kHorizontal, rubble);
  paintRubble(v, kVertical, rubble);
  CSeabedSkyMap near;
  near.insertObservation(h, toPose(kRobot));
  near.insertObservation(v, toPose(kRobot));
  EXPECT_GT(near.pointCount(Layer::Stereo), 10u);
  double sum = 0;
  near.forEachPoint(Layer::Stereo, [&](const MapPoint& p) { sum += (kRobot.inverse() * p.p_map - rubble).norm(); });
  // The rubble's half diagonal is 0.21 m and echoes are painted 0.05 m wide; a point whose halves were wrongly paired
  // still lies within its box. Larger rubble is ambiguous by more than stereo allows.
  EXPECT_LT(sum / static_cast<double>(near.pointCount(Layer::Stereo)), 0.25);

  CSeabedSkyMap apart;
  v.timestamp = s2s::core::toMrptTime(1'733'400'001'000'000'000);
  apart.insertObservation(h, toPose(kRobot));
  apart.insertObservation(v, toPose(kRobot));
  EXPECT_EQ(apart.pointCount(Layer::Stereo), 0u);
  EXPECT_GT(apart.pointCount(Layer::LineVertical), 0u);
}

TEST(MapInsertion, VesselMovedBetweenThePings_IsTakenOut) {
  const Isometry T_map_later = kRobot * isometryFromXyzYpr(0.08, 0.02, 0, 0.03, 0, 0);
  const Eigen::Vector3d rubble = kHorizontal * Eigen::Vector3d(4.5, 0.1, -0.1);
  auto h = spotPing(kHorizontal, 10, 380), v = spotPing(kVertical, 10, 380);
  paintRubble(h, kHorizontal, rubble);
  paintRubble(v, kVertical, T_map_later.inverse() * kRobot * rubble);
  v.timestamp = s2s::core::toMrptTime(1'733'400'000'050'000'000);
  CSeabedSkyMap map;
  map.insertObservation(h, toPose(kRobot));
  map.insertObservation(v, toPose(T_map_later));
  ASSERT_GT(map.pointCount(Layer::Stereo), 10u);
  double sum = 0;
  map.forEachPoint(Layer::Stereo, [&](const MapPoint& p) { sum += (kRobot.inverse() * p.p_map - rubble).norm(); });
  EXPECT_LT(sum / static_cast<double>(map.pointCount(Layer::Stereo)), 0.25);  // as above
}

TEST(MapInsertion, DamagedPing_IsRefusedAndLeavesNothing) {
  CSeabedSkyMap map;
  auto ping = spotPing(kHorizontal, 20, 200);
  ping.samples.pop_back();
  EXPECT_FALSE(map.insertObservation(ping, toPose(kRobot)));
  EXPECT_TRUE(map.keyframes().empty());
}

TEST(MapInsertion, ObservationWithoutPoints_IsRefused) {
  CSeabedSkyMap map;
  EXPECT_FALSE(map.insertObservation(mrpt::obs::CObservationIMU()));
  EXPECT_FALSE(map.insertObservation(mrpt::obs::CObservationPointCloud()));
  EXPECT_TRUE(map.isEmpty());
  EXPECT_TRUE(map.keyframes().empty());
}

TEST(MapInsertion, EachInsertion_IsAKeyframeOfItsOwn) {
  CSeabedSkyMap map(keepAll());
  // The same time twice, at different places, as a simple map may hold it: nothing may be interpolated between them.
  for (int i = 0; i < 3; ++i) {
    const Isometry T = isometryFromXyzYpr(i, 0, 0, 0, 0, 0);
    map.insertObservation(*s2s::test::sweepInRoom(T, kSensor), toPose(T));
  }
  ASSERT_EQ(map.keyframes().size(), 3u);
  const auto before = pointsOf(map, Layer::Lidar);
  map.setKeyframePoses({{map.keyframes()[1].id, isometryFromXyzYpr(1, 0, 100, 0, 0, 0)}});
  const auto after = pointsOf(map, Layer::Lidar);
  std::size_t lifted = 0;
  for (std::size_t i = 0; i < after.size(); ++i)
    if (std::abs(after[i].p_map.z() - before[i].p_map.z() - 100) < 1e-9) ++lifted;
  EXPECT_EQ(lifted, 32u * 256u);
}

TEST(MapInsertion, InsertionSwitchedOff_IsHonoured) {
  CSeabedSkyMap map;
  map.genericMapParams.enableObservationInsertion = false;
  EXPECT_FALSE(map.insertObservation(*s2s::test::sweepInRoom(kRobot, kSensor), toPose(kRobot)));
}

}  // namespace
