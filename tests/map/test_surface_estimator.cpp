#include <gtest/gtest.h>

#include <map>
#include <random>
#include <utility>

#include "leading_edge_scene.h"
#include "s2s/map/CSeabedSkyMap.h"
#include "s2s/map/surface_estimator.h"

namespace {

using namespace s2s::map;
using s2s::core::isometryFromXyzYpr;

MapPoint sounding(double x, double y, double z, s2s::core::TimeNs time, float sigma_m = 0.05f) {
  MapPoint p;
  p.p_map = {x, y, z};
  p.sigma_m = sigma_m;
  p.time = time;
  p.layer = Layer::Stereo;
  return p;
}

/// Pings of 50 soundings each on an uneven bed of some hundred metres.
std::vector<MapPoint> soundings(int pings, unsigned seed, double extent_m = 100) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-extent_m, extent_m), near(-3, 3);
  std::normal_distribution<double> noise(0, 0.04);
  std::vector<MapPoint> points;
  for (int ping = 0; ping < pings; ++ping) {
    const double x = place(random), y = place(random);
    for (int i = 0; i < 50; ++i) {
      const double px = x + near(random), py = y + near(random);
      points.push_back(sounding(px, py, -4 + 0.3 * std::sin(0.2 * px) + noise(random), 1 + ping,
                                static_cast<float>(0.03 + 0.01 * (i % 4))));
    }
  }
  return points;
}

using Cells = std::map<std::pair<int, int>, SurfaceEstimator::Cell>;
Cells cellsOf(const SurfaceEstimator& surface) {
  Cells cells;
  surface.forEachCell(0, [&](const SurfaceEstimator::Cell& cell) { cells[{cell.column, cell.row}] = cell; });
  return cells;
}

void expectSame(const Cells& a, const Cells& b) {
  ASSERT_EQ(a.size(), b.size());
  for (const auto& [place, cell] : a) {
    const auto other = b.find(place);
    ASSERT_NE(other, b.end());
    // Sums of doubles in another order: some parts in 1e15 of sums of squares; the height is of metres.
    EXPECT_NEAR(cell.height_m, other->second.height_m, 1e-9);
    EXPECT_NEAR(cell.sigma_m, other->second.sigma_m, 1e-9);
    EXPECT_EQ(cell.count, other->second.count);
  }
}

TEST(SurfaceEstimator, WhatWasTakenOutAgain_LeavesNoTrace) {
  const auto stay = soundings(600, 1), go = soundings(400, 2);
  SurfaceEstimator plain, changed;
  for (const auto& p : stay) plain.add(p);
  for (const auto& p : go) changed.add(p);
  for (const auto& p : stay) changed.add(p);
  for (const auto& p : go) changed.remove(p);
  const auto cells = cellsOf(plain);
  EXPECT_GT(cells.size(), 500u);
  expectSame(cells, cellsOf(changed));
  for (const auto& p : stay) changed.remove(p);
  EXPECT_TRUE(cellsOf(changed).empty());
}

TEST(SurfaceEstimator, TilesOutOfMemory_GiveTheSameSurface) {
  SurfaceOptions few;
  few.maxTilesInMemory = 8;
  SurfaceEstimator whole, tiled(few);
  const auto points = soundings(800, 3);
  for (const auto& p : points) {
    whole.add(p);
    tiled.add(p);
  }
  EXPECT_GT(tiled.tileCount(), 100u);
  EXPECT_LE(tiled.tilesInMemory(), 8u);
  expectSame(cellsOf(whole), cellsOf(tiled));
  // Tiles come back, change and go again.
  for (std::size_t i = 0; i < 20'000; ++i) {
    whole.remove(points[i]);
    tiled.remove(points[i]);
  }
  expectSame(cellsOf(whole), cellsOf(tiled));
}

TEST(SurfaceEstimator, WallPointsAndLidar_AreNoSeabed) {
  SurfaceEstimator surface;
  for (int i = 0; i < 20; ++i) {
    MapPoint p = sounding(0.1, 0.1, -2, i + 1);
    p.isWall = true;
    surface.add(p);
    p.isWall = false;
    p.layer = Layer::Lidar;
    surface.add(p);
  }
  EXPECT_TRUE(cellsOf(surface).empty());
}

TEST(SurfaceEstimator, SigmaAgainstTheTruth_IsHonest) {
  // A level bed; each ping has an error of its own of 4 cm, and claims 4 cm.
  std::mt19937 random(4);
  std::normal_distribution<double> noise(0, 0.04);
  SurfaceEstimator surface;
  for (int cell = 0; cell < 400; ++cell)
    for (int ping = 0; ping < 10; ++ping) {
      const double error_m = noise(random);
      for (int i = 0; i < 10; ++i) surface.add(sounding(0.5 * cell + 0.25, 0.1, -4 + error_m, 1 + ping, 0.04f));
    }
  std::size_t within2 = 0;
  const auto cells = cellsOf(surface);
  for (const auto& [place, cell] : cells) within2 += std::abs(cell.height_m + 4) <= 2 * cell.sigma_m ? 1 : 0;
  EXPECT_EQ(cells.size(), 400u);
  // The median of ten pings is better than one ping, whose sigma is stated: 95 % at least.
  EXPECT_GE(static_cast<double>(within2), 0.95 * static_cast<double>(cells.size()));
}

TEST(SurfaceEstimator, GraphMovesTheMap_SurfaceMovesAlong) {
  s2s::test::LeadingEdgeScene scene;
  scene.add(s2s::test::LeadingEdgeScene::seabed(-3.4));
  CSeabedSkyMap map;
  const auto wrong = isometryFromXyzYpr(40, -20, 1.5, 0.7, 0, 0);
  map.addKeyframe({0, 0, s2s::core::Isometry::Identity(), wrong});
  std::size_t grew = 0, before = 0;
  for (int i = 0; i < 30; ++i) {
    const auto T = isometryFromXyzYpr(0.1 * i, 0, 0, 0, 0, 0);
    map.insertLineScan(Layer::LineHorizontal, s2s::core::durationNs(0.1 * i), T,
                       scene.ping(T, s2s::test::horizontalMount(), s2s::test::kHorizontalHalfFan, 128));
    const std::size_t cells = cellsOf(map.surface()).size();
    grew += cells > before ? 1 : 0;
    before = cells;
  }
  EXPECT_GT(grew, 20u);  // with every ping, or nearly
  map.setKeyframePoses({{0, s2s::core::Isometry::Identity()}});
  const auto cells = cellsOf(map.surface());
  ASSERT_FALSE(cells.empty());
  // The bed is level and without noise: what is left is half a histogram bin, and single precision.
  for (const auto& [place, cell] : cells) EXPECT_NEAR(cell.height_m, -3.4, 0.006);
  CSeabedSkyMap copy(map);
  expectSame(cells, cellsOf(copy.surface()));
}

}  // namespace
