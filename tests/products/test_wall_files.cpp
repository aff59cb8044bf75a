#include <gtest/gtest.h>

#include "s2s/products/ply_reader.h"
#include "s2s/products/wall_files.h"
#include "temp_folder.h"

namespace s2s::products {
namespace {

std::vector<map::WallEstimator::Cell> someCells() {
  std::vector<map::WallEstimator::Cell> cells(3);
  for (int i = 0; i < 3; ++i) {
    auto& cell = cells[static_cast<std::size_t>(i)];
    cell.p_map = {1e6 + 0.25 * i, -12.5, -1.125};
    cell.outward_map = {0, 1};
    cell.offset_m = 0.01 * i;
    cell.sigma_m = 0.02;
    cell.count = 7;
    cell.bySonar = i > 0;
  }
  return cells;
}

TEST(WallFiles, Ply_IsReadAsACloudWithSigma) {
  const test::TempFolder folder;
  writeWallPly(folder.file("walls.ply"), someCells());
  const auto points = readPlyPoints(folder.file("walls.ply"));
  ASSERT_EQ(points.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(points[i].p, someCells()[i].p_map);
    EXPECT_FLOAT_EQ(points[i].sigma_m, 0.02f);
    EXPECT_EQ(points[i].source, i > 0 ? 1 : 0);
  }
}

TEST(WallFiles, Areas_AreThoseOfTheCellsOfEachSensor) {
  const auto statistics = wallStatistics(someCells(), 0.5);
  EXPECT_DOUBLE_EQ(statistics.lidarArea_m2, 0.25);
  EXPECT_DOUBLE_EQ(statistics.sonarArea_m2, 0.5);
}

TEST(WallFiles, NoWall_GivesAnEmptyCloud) {
  const test::TempFolder folder;
  EXPECT_TRUE(wallCells(map::WallEstimator()).empty());
  writeWallPly(folder.file("walls.ply"), {});
  EXPECT_TRUE(readPlyPoints(folder.file("walls.ply")).empty());
}

}  // namespace
}  // namespace s2s::products
