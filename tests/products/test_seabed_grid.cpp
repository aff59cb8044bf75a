#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "error_text.h"
#include "s2s/core/error.h"
#include "s2s/products/grid_files.h"
#include "s2s/products/seabed_gridder.h"
#include "temp_folder.h"

namespace s2s::products {
namespace {

using test::errorText;
using test::readBytes;
using test::TempFolder;
using test::writeBytes;
using testing::HasSubstr;

constexpr double kWater_m = 0.25;

/// A surface and its grid.
class SeabedGridder {
 public:
  SeabedGridder(const SeabedGridOptions& options, double waterHeight_m)
      : options_(options), waterHeight_m_(waterHeight_m), surface_(options) {}
  void add(const map::MapPoint& point) { surface_.add(point); }
  HeightGrid grid() { return gridOf(surface_, waterHeight_m_, options_, &statistics_); }
  const SeabedGridStatistics& statistics() const { return statistics_; }

 private:
  SeabedGridOptions options_;
  double waterHeight_m_;
  map::SurfaceEstimator surface_;
  SeabedGridStatistics statistics_;
};

map::MapPoint sounding(double x, double y, double z, double sigma, map::Layer layer = map::Layer::Stereo) {
  map::MapPoint p;
  p.p_map = {x, y, z};
  p.sigma_m = static_cast<float>(sigma);
  p.layer = layer;
  return p;
}

double plane(double x, double y) { return -4 + 0.1 * x - 0.05 * y; }

/// Soundings on the tilted plane over x in [-5, 5], y in [0, 8], with vertical noise.
template <class Add>
void addPlane(std::mt19937& random, double noise_m, int count, const Add& add) {
  std::uniform_real_distribution<double> ux(-5, 5), uy(0, 8);
  std::normal_distribution<double> noise(0, noise_m);
  for (int i = 0; i < count; ++i) {
    const double x = ux(random), y = uy(random);
    auto p = sounding(x, y, plane(x, y) + noise(random), 0.05);
    p.time = i;  // pings of one sounding
    add(p);
  }
}

/// Largest and root-mean-square difference between the grid and the plane at the cell centres.
std::pair<double, double> errorsToPlane(const HeightGrid& grid) {
  double largest = 0, square = 0;
  int cells = 0;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      if (!grid.hasValue(column, row)) continue;
      const Eigen::Vector2d c = grid.centre(column, row);
      const double error = std::abs(static_cast<double>(grid.height_m[grid.index(column, row)]) - plane(c.x(), c.y()));
      largest = std::max(largest, error);
      square += error * error;
      ++cells;
    }
  return {largest, std::sqrt(square / cells)};
}

TEST(SeabedGridder, TiltedPlane_IsFoundAtTheCellCentres) {
  std::mt19937 random(1);
  SeabedGridder gridder({}, kWater_m);
  addPlane(random, 0.05, 64'000, [&](const auto& p) { gridder.add(p); });
  const HeightGrid grid = gridder.grid();
  EXPECT_EQ(grid.columns, 20);
  EXPECT_EQ(grid.rows, 16);
  EXPECT_DOUBLE_EQ(grid.west_m, -5);
  EXPECT_DOUBLE_EQ(grid.south_m, 0);
  EXPECT_EQ(gridder.statistics().cells, 320U);
  EXPECT_DOUBLE_EQ(gridder.statistics().area_m2, 80);
  // 200 soundings a cell, 5 cm noise: the median's standard error is 1.2533 * 0.05 / sqrt(200) = 4.4 mm, the slope adds
  // little and the 1 cm bins another 3 mm; four sigma of that over 320 cells.
  const auto [largest, rms] = errorsToPlane(grid);
  EXPECT_LT(largest, 0.022);
  EXPECT_LT(rms, 0.0065);
  // Scatter of a single ping: noise, and the slope's even spread over the cell, 0.5 m times 0.1 and 0.05 over sqrt(12).
  double sum = 0;
  for (const float sigma : grid.sigma_m) sum += sigma;
  // The mean of 320 robust estimates from 200 each; 1 mm for the bins and the estimator's small-sample bias.
  EXPECT_NEAR(sum / 320, std::sqrt(0.05 * 0.05 + (0.05 * 0.05 + 0.025 * 0.025) / 12), 0.001);
}

TEST(SeabedGridder, FalseEchoes_DoNotMoveIt) {
  std::mt19937 random(2);
  SeabedGridder gridder({}, kWater_m);
  addPlane(random, 0.03, 64'000, [&](const auto& p) { gridder.add(p); });
  // A fifth as many echoes anywhere in the water, and a tenth as many below the ground.
  std::uniform_real_distribution<double> ux(-5, 5), uy(0, 8), above(0, 3), below(-2, 0);
  for (int i = 0; i < 12'800; ++i) {
    const double x = ux(random), y = uy(random);
    gridder.add(sounding(x, y, plane(x, y) + above(random), 0.05));
  }
  for (int i = 0; i < 6'400; ++i) {
    const double x = ux(random), y = uy(random);
    gridder.add(sounding(x, y, plane(x, y) + below(random), 0.05));
  }
  const auto [largest, rms] = errorsToPlane(gridder.grid());
  // As without them, plus what 30 % of evenly spread echoes shift a median inside the 0.4 m layer: below 1 cm.
  EXPECT_LT(largest, 0.035);
  EXPECT_LT(rms, 0.01);
}

TEST(SeabedGridder, QuayWall_DoesNotLiftTheSeabedBesideIt) {
  std::mt19937 random(3);
  SeabedGridder gridder({}, kWater_m);
  addPlane(random, 0.03, 64'000, [&](const auto& p) { gridder.add(p); });
  // A quay along x = 4.9 from the ground to the surface, as dense along its height as the ground in its cells.
  std::uniform_real_distribution<double> uy(0, 8), height(0, 4);
  std::normal_distribution<double> noise(0, 0.03);
  for (int i = 0; i < 12'000; ++i) {
    const double y = uy(random);
    const double x = 4.9 + noise(random);
    gridder.add(sounding(x, y, plane(x, y) + height(random), 0.05));
  }
  // And one along x = 7.1 whose foot was never seen.
  for (int i = 0; i < 12'000; ++i) gridder.add(sounding(7.1 + noise(random), uy(random), -4 + height(random), 0.05));
  const HeightGrid grid = gridder.grid();
  const auto [largest, rms] = errorsToPlane(grid);
  EXPECT_LT(largest, 0.1);  // a plain mean of these cells would be 1 m too high
  EXPECT_LT(rms, 0.015);
  EXPECT_TRUE(grid.heightAt(4.75, 4.25).has_value());
  EXPECT_FALSE(grid.heightAt(7.1, 4.25).has_value()) << "a wall alone is no seabed";
  EXPECT_GE(gridder.statistics().walls, 16U);
}

TEST(SeabedGridder, MooredHull_IsRemovedAsAStep) {
  std::mt19937 random(4);
  SeabedGridder gridder({}, kWater_m);
  addPlane(random, 0.02, 64'000, [&](const auto& p) {
    // The hull hides the ground below it.
    if (std::abs(p.p_map.x()) < 0.5 && std::abs(p.p_map.y() - 4) < 0.5)
      gridder.add(sounding(p.p_map.x(), p.p_map.y(), -0.8, 0.05));
    else
      gridder.add(p);
  });
  const HeightGrid grid = gridder.grid();
  EXPECT_FALSE(grid.heightAt(0.25, 4.25).has_value());
  EXPECT_EQ(gridder.statistics().steps, 4U);
  EXPECT_EQ(gridder.statistics().cells, 316U);
}

TEST(SeabedGridder, PreciseSoundings_OutweighUncertainOnes) {
  SeabedGridder gridder({}, kWater_m);
  for (int i = 0; i < 10; ++i) gridder.add(sounding(0.1, 0.1, -3.0, 0.05));
  for (int i = 0; i < 100; ++i) gridder.add(sounding(0.1, 0.1, -2.7, 0.5, map::Layer::LineHorizontal));
  const HeightGrid grid = gridder.grid();
  ASSERT_EQ(grid.columns, 1);
  EXPECT_NEAR(grid.height_m[0], -3.0, 1e-6);  // weight 10 * 400 against 100 * 4
  EXPECT_EQ(grid.count[0], 110U);
  // All of one ping and without scatter: claimed variance n / sum of weights, halved.
  EXPECT_NEAR(grid.sigma_m[0], std::sqrt(110.0 / 4400.0 / 2), 1e-6);
}

TEST(SeabedGridder, Sigma_FollowsTheScatterOfManyPingsRatherThanTheirClaims) {
  std::mt19937 random(9);
  std::normal_distribution<double> noise(0, 0.05);
  SeabedGridder gridder({}, kWater_m);
  constexpr int kPings = 400;
  for (int i = 0; i < kPings; ++i) {
    auto modest = sounding(0.1, 0.1, -3 + noise(random), 1.0), boastful = sounding(5.1, 0.1, -3 + noise(random), 0.001);
    modest.time = boastful.time = i;
    gridder.add(modest);
    gridder.add(boastful);
  }
  const HeightGrid grid = gridder.grid();
  ASSERT_EQ(grid.columns, 11);
  // (1 m)² counts as one ping of 401, the 400 others scatter by 5 cm. A MAD of 400 is good to 6 %, three sigma of it.
  const double modest = std::sqrt((1.0 + kPings * 0.0025) / (1 + kPings));
  EXPECT_NEAR(grid.sigma_m[0], modest, 0.09 * modest);
  EXPECT_NEAR(grid.sigma_m[10], 0.05, 0.18 * 0.05);
}

TEST(SeabedGridder, SoundingsOfOnePing_AreNoRepetition) {
  SeabedGridder gridder({}, kWater_m);
  for (int i = 0; i < 100; ++i) gridder.add(sounding(0.1, 0.1, -3.0, 1.0));
  // No scatter, but one look: (1 + 1 * 0) / 2.
  EXPECT_NEAR(gridder.grid().sigma_m[0], std::sqrt(0.5), 1e-6);
}

TEST(SeabedGridder, LidarShallowAndBrokenPoints_AreLeftOutAndCounted) {
  SeabedGridder gridder({}, kWater_m);
  for (int i = 0; i < 5; ++i) gridder.add(sounding(0, 0, -3, 0.05, map::Layer::Lidar));
  for (int i = 0; i < 5; ++i) gridder.add(sounding(0, 0, 0.1, 0.05));  // 15 cm below the surface
  gridder.add(sounding(std::nan(""), 0, -3, 0.05));
  gridder.add(sounding(0, std::nan(""), -3, 0.05));
  gridder.add(sounding(0, 1e300, -3, 0.05));
  gridder.add(sounding(0, 0, -3, 0.05));  // one alone
  const HeightGrid grid = gridder.grid();
  EXPECT_EQ(grid.columns, 0);
  EXPECT_EQ(gridder.statistics().soundings, 9U);
  EXPECT_EQ(gridder.statistics().tooShallow, 5U);
  EXPECT_EQ(gridder.statistics().notFinite, 3U);
  EXPECT_EQ(gridder.statistics().fewPoints, 1U);
}

TEST(SeabedGridder, PointsWorldsApart_AreRefusedWithTheSize) {
  SeabedGridder gridder({}, kWater_m);
  for (int i = 0; i < 3; ++i) gridder.add(sounding(0, 0, -3, 0.05));
  for (int i = 0; i < 3; ++i) gridder.add(sounding(1e7, 1e7, -3, 0.05));
  EXPECT_THAT(errorText<core::OutputError>([&] { gridder.grid(); }), HasSubstr("cells"));
}

HeightGrid sampleGrid() {
  HeightGrid grid(-12.5, 100, 0.5, 37, 21);
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      if ((row + column) % 5 == 0) continue;
      const std::size_t at = grid.index(column, row);
      grid.height_m[at] = -3.0F + 0.01F * static_cast<float>(column) - 0.1F * static_cast<float>(row);
      grid.sigma_m[at] = 0.05F + 0.001F * static_cast<float>(row);
      grid.count[at] = static_cast<std::uint32_t>(7 + column * row);
    }
  return grid;
}

void expectSame(const std::vector<float>& a, const std::vector<float>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    EXPECT_TRUE(a[i] == b[i] || (std::isnan(a[i]) && std::isnan(b[i]))) << "cell " << i;
}

TEST(GridFiles, GeoTiff_ReadsBackExactly) {
  const TempFolder folder;
  const HeightGrid grid = sampleGrid();
  writeGeoTiff(folder.file("seabed.tif"), grid);
  EXPECT_EQ(folder.fileCount(), 1U);  // no side-car files
  const HeightGrid back = readGrid(folder.file("seabed.tif"));
  EXPECT_DOUBLE_EQ(back.west_m, grid.west_m);
  EXPECT_DOUBLE_EQ(back.south_m, grid.south_m);
  EXPECT_DOUBLE_EQ(back.cell_m, grid.cell_m);
  ASSERT_EQ(back.columns, grid.columns);
  ASSERT_EQ(back.rows, grid.rows);
  expectSame(back.height_m, grid.height_m);
  expectSame(back.sigma_m, grid.sigma_m);
  EXPECT_EQ(back.count, grid.count);
}

TEST(GridFiles, Bag_HoldsTheSameHeightsAndUncertainties) {
  const TempFolder folder;
  const HeightGrid grid = sampleGrid();
  writeBag(folder.file("seabed.bag"), grid, 1'733'400'000'000'000'000);
  EXPECT_EQ(folder.fileCount(), 1U);
  EXPECT_EQ(readBytes(folder.file("seabed.bag")).substr(1, 3), "HDF");
  const HeightGrid back = readGrid(folder.file("seabed.bag"));
  EXPECT_DOUBLE_EQ(back.west_m, grid.west_m);
  EXPECT_DOUBLE_EQ(back.south_m, grid.south_m);
  ASSERT_EQ(back.columns, grid.columns);
  ASSERT_EQ(back.rows, grid.rows);
  expectSame(back.height_m, grid.height_m);
  expectSame(back.sigma_m, grid.sigma_m);
}

TEST(GridFiles, BadInput_IsAnInputError) {
  const TempFolder folder;
  EXPECT_THAT(errorText<core::InputError>([&] { readGrid(folder.file("absent.tif")); }), HasSubstr("absent.tif"));
  writeBytes(folder.file("text.tif"), "no raster");
  EXPECT_THROW(readGrid(folder.file("text.tif")), core::InputError);
  writeGeoTiff(folder.file("good.tif"), sampleGrid());
  const std::string bytes = readBytes(folder.file("good.tif"));
  writeBytes(folder.file("cut.tif"), bytes.substr(0, bytes.size() / 2));
  EXPECT_THROW(readGrid(folder.file("cut.tif")), core::InputError);
}

TEST(GridFiles, EmptyGridOrUnwritableFolder_LeavesNothing) {
  const TempFolder folder;
  EXPECT_THROW(writeGeoTiff(folder.file("a.tif"), HeightGrid(0, 0, 0.5, 0, 0)), core::OutputError);
  EXPECT_THROW(writeBag(folder.file("a.bag"), HeightGrid(0, 0, 0.5, 0, 0), 0), core::OutputError);
  EXPECT_EQ(folder.fileCount(), 0U);
  writeBytes(folder.file("taken"), "x");
  EXPECT_THROW(writeGeoTiff(folder.file("taken/a.tif"), sampleGrid()), core::OutputError);
  EXPECT_THROW(writeBag(folder.file("taken/a.bag"), sampleGrid(), 0), core::OutputError);
  EXPECT_EQ(folder.fileCount(), 1U);
}

}  // namespace
}  // namespace s2s::products
