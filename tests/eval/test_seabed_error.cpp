#include "s2s/eval/seabed_error.h"

#include <gtest/gtest.h>

#include "test_meshes.h"

using namespace s2s;
using namespace s2s::eval;

namespace {

products::PlyMesh flatSeabed(double depth_m) {
  products::PlyMesh mesh;
  addTerrain(
      mesh, -10, 10, -10, 10, 1, [&](double, double) { return -depth_m; }, 0);
  return mesh;
}

core::Trajectory straightPath() {
  core::Trajectory trajectory;
  for (int i = -50; i <= 50; ++i)
    trajectory.append((i + 100) * core::kNsPerSecond, core::isometryFromXyzYpr(0.1 * i, 0, 0, 0, 0, 0));
  return trajectory;
}

}  // namespace

TEST(SeabedError, ErrorsOnEitherSideOfEachOrder_AreCountedByTheStandard) {
  // At 4 m depth the TVU are sqrt(0.15² + 0.03²) = 0.1530, sqrt(0.25² + 0.03²) = 0.2518, sqrt(0.5² + 0.052²) = 0.5027.
  products::HeightGrid grid(-4, -4, 0.5, 16, 16);
  const std::vector<double> errors = {0.152, -0.152, 0.154, -0.25, 0.253, 0.502, 0.504, -0.6};
  for (std::size_t i = 0; i < errors.size(); ++i) {
    grid.height_m[grid.index(static_cast<int>(i), 3)] = static_cast<float>(-4 + errors[i]);
    grid.sigma_m[grid.index(static_cast<int>(i), 3)] = 0.1F;
  }
  const MeshQuery seabed(flatSeabed(4));
  const SeabedError error = compareSeabed(grid, core::Isometry::Identity(), seabed, straightPath(), {});
  EXPECT_EQ(error.cells, 8u);
  EXPECT_DOUBLE_EQ(error.withinOrder[0], 2.0 / 8);
  EXPECT_DOUBLE_EQ(error.withinOrder[1], 4.0 / 8);
  EXPECT_DOUBLE_EQ(error.withinOrder[2], 6.0 / 8);
  EXPECT_DOUBLE_EQ(error.withinTwoSigma, 3.0 / 8);
  double sum = 0, squares = 0;
  for (const double e : errors) {
    sum += e;
    squares += e * e;
  }
  // Heights of 4 m in single precision: 2.4e-7 m.
  EXPECT_NEAR(error.bias_m, sum / 8, 1e-6);
  EXPECT_NEAR(error.rmse_m, std::sqrt(squares / 8), 1e-6);
  EXPECT_NEAR(error.max_m, 0.6, 1e-6);
}

TEST(SeabedError, StepInsideACell_IsComparedWithItsMean) {
  // A step of 1 m through the middle of the only cell: the mean of the true surface is half-way.
  products::PlyMesh mesh;
  addTerrain(
      mesh, -10, 0, -10, 10, 1, [](double, double) { return -4.0; }, 0);
  addTerrain(
      mesh, 0, 10, -10, 10, 1, [](double, double) { return -3.0; }, 0);
  products::HeightGrid grid(-0.25, -0.25, 0.5, 1, 1);
  grid.height_m[0] = -3.5F;
  SeabedErrorOptions options;
  options.raysPerSide = 4;  // an even number, so that none falls on the step
  const SeabedError error =
      compareSeabed(grid, core::Isometry::Identity(), MeshQuery(std::move(mesh)), straightPath(), options);
  EXPECT_NEAR(error.bias_m, 0, 1e-6);
}

TEST(SeabedError, CellsBesideTheSeabed_AreCountedApart) {
  products::HeightGrid grid(8.25, 0, 0.5, 10, 1);  // centres at 8.5, 9 … 13
  for (auto& height : grid.height_m) height = -4;
  const SeabedError error =
      compareSeabed(grid, core::Isometry::Identity(), MeshQuery(flatSeabed(4)), straightPath(), {});
  EXPECT_EQ(error.cells, 4u);  // 8.5, 9, 9.5, and 10 of which half the rays hit
  EXPECT_EQ(error.withoutTruth, 6u);
}

TEST(SeabedError, HalfTheStripMapped_IsHalfCovered) {
  products::HeightGrid grid(-10, 0, 0.5, 40, 20);  // y >= 0 only
  for (auto& height : grid.height_m) height = -4;
  SeabedErrorOptions options;
  options.coverageRadius_m = 3;
  const SeabedError error =
      compareSeabed(grid, core::Isometry::Identity(), MeshQuery(flatSeabed(4)), straightPath(), options);
  EXPECT_NEAR(error.coverage, 0.5, 0.02);  // a row of cells more on one side, as the path's row belongs to y >= 0
  // A strip of 10 m x 6 m and two half discs, in cells of 0.25 m²; the edge of 38.8 m crosses cells.
  EXPECT_NEAR(static_cast<double>(error.trueCells) * 0.25, 60 + 9 * M_PI, 38.8 * 0.25);
}

TEST(SeabedError, EmptyGrid_HasNoErrors) {
  const SeabedError error = compareSeabed(products::HeightGrid(0, 0, 0.5, 4, 4), core::Isometry::Identity(),
                                          MeshQuery(flatSeabed(4)), straightPath(), {});
  EXPECT_EQ(error.cells, 0u);
  EXPECT_EQ(error.coverage, 0);
  EXPECT_EQ(error.rmse_m, 0);
}
