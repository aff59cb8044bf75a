#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <tuple>
#include <vector>

#include "leading_edge_scene.h"
#include "s2s/map/CSeabedSkyMap.h"
#include "s2s/map/wall_estimator.h"

namespace {

using namespace s2s::map;
using namespace s2s::test;
using s2s::core::durationNs;
using s2s::core::Isometry;
using s2s::core::isometryFromXyzYpr;

constexpr double kNoise_m = 0.02;

/// The wall y = 4 m + slope x, seen from below; a bulge of 6 cm over two metres at x = 10 m.
double faceOf(double x, double bulge_m) { return 4 + 0.04 * x - (std::abs(x - 10) < 1 ? bulge_m : 0); }

std::vector<MapPoint> wallPoints(int pings, double bulge_m, unsigned seed, Layer layer = Layer::LineHorizontal) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> along(0, 20), height(-3, -1);
  std::normal_distribution<double> noise(0, kNoise_m);
  std::vector<MapPoint> points;
  for (int ping = 0; ping < pings; ++ping)
    for (int i = 0; i < 40; ++i) {
      MapPoint p;
      const double x = along(random);
      p.p_map = {x, faceOf(x, bulge_m) + noise(random), height(random)};
      p.sigma_m = kNoise_m;
      p.time = 1000 * static_cast<s2s::core::TimeNs>(seed) + ping;  // no ping of another call has it
      p.layer = layer;
      p.isWall = layer != Layer::Lidar;
      points.push_back(p);
    }
  return points;
}

void learnWall(WallEstimator& walls) {
  const Eigen::Vector2d outward = Eigen::Vector2d(0.04, -1).normalized();
  for (double x = 0; x < 20; x += 0.25) {
    const Eigen::Vector2d place(x, faceOf(x, 0));
    walls.learn(place, outward, outward.dot(place));
  }
}

std::vector<WallEstimator::Cell> cellsOf(const WallEstimator& walls) {
  std::vector<WallEstimator::Cell> cells;
  walls.forEachCell([&](const WallEstimator::Cell& cell) { cells.push_back(cell); });
  return cells;
}

TEST(WallEstimator, Bulge_IsFoundWhereItIsAndAsLargeAsItIs) {
  WallEstimator walls;
  learnWall(walls);
  for (const auto& p : wallPoints(400, 0.06, 1)) walls.add(p);
  const auto cells = cellsOf(walls);
  ASSERT_GT(cells.size(), 600u);  // 20 m by 2 m at 0.25 m are 640
  double bulge_m = 0, rest_m = 0, sigma_m = 0, bulges = 0, rest = 0, near = 0;
  for (const auto& cell : cells) {
    EXPECT_TRUE(cell.bySonar);
    EXPECT_NEAR(cell.outward_map.y(), -1, 0.01);
    sigma_m += cell.sigma_m / static_cast<double>(cells.size());
    if (std::abs(cell.p_map.x() - 10) < 0.7) bulge_m += cell.offset_m, ++bulges;
    if (std::abs(cell.p_map.x() - 10) < 1.2) continue;
    near += std::abs(cell.p_map.y() - faceOf(cell.p_map.x(), 0)) < 0.012 ? 1 : 0;
    if (std::abs(cell.p_map.x() - 10) > 3) rest_m += std::abs(cell.offset_m), ++rest;
  }
  // A median of some 25 points of 2 cm is known to 5 mm, of some fewer where chance left few.
  EXPECT_GT(near, 0.9 * 560);
  EXPECT_NEAR(sigma_m, kNoise_m, 0.003);
  // The plane is of 10 m along the wall, of which the bulge is a fifth: it takes 1.2 cm of the 6.
  EXPECT_NEAR(bulge_m / bulges, 0.048, 0.006);
  EXPECT_LT(rest_m / rest, 0.015);
}

/// A wall with the LiDAR's and the sonar's points; the sonar sees the middle of a profile that the LiDAR resolves, and
/// the LiDAR's part of the wall stands back by a step.
std::vector<WallEstimator::Cell> sonarCells(double profile_m, double step_m) {
  const auto profile = [&](double x) { return profile_m * std::sin(2 * M_PI * x / 1.2); };
  WallEstimator walls;
  learnWall(walls);
  for (auto p : wallPoints(800, 0, 11, Layer::Lidar)) {
    p.p_map += Eigen::Vector3d(0, profile(p.p_map.x()) + step_m, 4);
    walls.add(p);
  }
  for (const auto& p : wallPoints(400, 0, 12)) walls.add(p);
  std::vector<WallEstimator::Cell> cells;
  for (const auto& cell : cellsOf(walls))
    if (cell.bySonar) cells.push_back(cell);
  return cells;
}

double meanSigma(const std::vector<WallEstimator::Cell>& cells) {
  double sum = 0;
  for (const auto& cell : cells) sum += cell.sigma_m / static_cast<double>(cells.size());
  return sum;
}

TEST(WallEstimator, ProfileThatOnlyTheLidarResolves_SonarsSigmaSaysSo) {
  constexpr double kProfile_m = 0.15;
  const auto cells = sonarCells(kProfile_m, 0);
  ASSERT_GT(cells.size(), 600u);
  std::size_t held = 0;
  for (const auto& cell : cells) {
    const double x = cell.p_map.x(), truth = faceOf(x, 0) + kProfile_m * std::sin(2 * M_PI * x / 1.2);
    held += std::abs(cell.p_map.y() - truth) <= 2 * cell.sigma_m ? 1 : 0;
  }
  // A sine's deviation is never more than 1.41 of its standard deviation.
  EXPECT_GT(static_cast<double>(held), 0.95 * static_cast<double>(cells.size()));
  // No more than the profile: its root mean square, less by what cells of 0.25 m average, and the noise.
  EXPECT_LT(meanSigma(cells), std::hypot(kProfile_m / std::sqrt(2.0), kNoise_m) + 0.01);
}

TEST(WallEstimator, PlainWall_TheLidarAddsNothingToTheSonarsSigma) {
  EXPECT_NEAR(meanSigma(sonarCells(0, 0)), kNoise_m, 0.003);
}

TEST(WallEstimator, PlainWallWithAStepAtTheWater_IsNoProfile) {
  EXPECT_NEAR(meanSigma(sonarCells(0, 0.2)), kNoise_m, 0.004);
}

TEST(WallEstimator, WhatWasTakenOutAgain_LeavesNoTrace) {
  WallEstimator plain, changed;
  learnWall(plain);
  const auto early = wallPoints(20, 0.06, 5);
  for (const auto& p : early) changed.add(p);  // its wall is not known yet: this must not be taken out later
  const auto before = changed.epoch();
  learnWall(changed);
  for (const auto& p : early) changed.remove(p, before);
  const auto stay = wallPoints(100, 0, 2), go = wallPoints(100, 0.06, 3);
  for (const auto& p : stay) plain.add(p);
  const auto epoch = changed.epoch();
  for (const auto& p : go) changed.add(p);
  for (const auto& p : stay) changed.add(p);
  for (const auto& p : go) changed.remove(p, epoch);
  const auto a = cellsOf(plain), b = cellsOf(changed);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_LT((a[i].p_map - b[i].p_map).norm(), 1e-9);
    EXPECT_NEAR(a[i].offset_m, b[i].offset_m, 1e-9);
    EXPECT_NEAR(a[i].sigma_m, b[i].sigma_m, 1e-9);
    EXPECT_EQ(a[i].count, b[i].count);
  }
}

TEST(WallEstimator, LidarAndSonar_AreKeptApartAndWhatIsNotOfTheWallIsLeftOut) {
  WallEstimator walls;
  learnWall(walls);
  for (auto p : wallPoints(100, 0, 6, Layer::Lidar)) {
    p.p_map.z() += 4;
    walls.add(p);
  }
  auto bed = wallPoints(100, 0, 7, Layer::LineHorizontal);
  for (auto& p : bed) {
    p.isWall = false;
    walls.add(p);
  }
  for (auto& p : bed) {  // a ship half a metre in front
    p.layer = Layer::Lidar;
    p.p_map.y() -= 0.5;
    walls.add(p);
  }
  const auto cells = cellsOf(walls);
  ASSERT_GT(cells.size(), 300u);
  for (const auto& cell : cells) {
    EXPECT_FALSE(cell.bySonar);
    EXPECT_GT(cell.p_map.z(), 0.9);
  }
}

TEST(CSeabedSkyMap, GraphMoves_WallsMoveAlong) {
  LeadingEdgeScene scene;
  scene.add(LeadingEdgeScene::seabed(-5.4));
  scene.add({-Eigen::Vector3d::UnitY(), -4.0, [](const Eigen::Vector3d& p) { return p.z() < 2; }});
  CSeabedSkyMap map;
  map.addKeyframe({0, 0, Isometry::Identity(), Isometry::Identity()});
  std::vector<ScanPoint> points;
  for (float x = -8; x <= 14; x += 0.1f)
    for (float z = 0.1f; z <= 2; z += 0.1f) points.push_back({{x, 4.0f, z}, 1, 0.02f});
  map.insertScan(Layer::Lidar, 0, Isometry::Identity(), points);
  for (int i = 0; i < 30; ++i) {
    const Isometry T = isometryFromXyzYpr(0.1 * i, 0, 0, 20 * kDegree, 0, 0);
    map.insertLineScan(Layer::LineHorizontal, durationNs(0.1 * i), T, scene.ping(T, horizontalMount(), 1.0, 64));
  }
  map.resolveLineScans();
  const auto places = [&] {
    std::vector<std::tuple<bool, double>> out;  // by sonar, y
    for (const auto& cell : cellsOf(map.walls())) out.emplace_back(cell.bySonar, cell.p_map.y());
    return out;
  };
  const auto count = [](const auto& cells, bool bySonar) {
    return std::count_if(cells.begin(), cells.end(), [&](const auto& c) { return std::get<0>(c) == bySonar; });
  };
  const auto before = places();
  ASSERT_GT(count(before, true), 10);
  ASSERT_GT(count(before, false), 10);
  map.setKeyframePoses({{0, isometryFromXyzYpr(0, 0.7, 0, 0, 0, 0)}});
  const auto moved = places();
  EXPECT_GT(count(moved, true), 0.9 * count(before, true));
  EXPECT_GT(count(moved, false), 0.9 * count(before, false));
  // Nothing is left behind; the sonar's own error in this scene is a few centimetres at the most.
  for (const auto& [bySonar, y] : moved) EXPECT_NEAR(y, 4.7, bySonar ? 0.1 : 0.01);
}

}  // namespace
