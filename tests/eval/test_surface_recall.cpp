#include "s2s/eval/surface_recall.h"

#include <gtest/gtest.h>

#include <cmath>

#include "test_meshes.h"

using namespace s2s;
using namespace s2s::eval;

namespace {

core::Trajectory restingAt(const Eigen::Vector3d& p) {
  core::Trajectory trajectory;
  trajectory.append(1, core::isometryFromXyzYpr(p.x(), p.y(), p.z(), 0, 0, 0));
  return trajectory;
}

products::PlyMesh flatFloor(double z) {
  products::PlyMesh mesh;
  addTerrain(
      mesh, -20, 20, -20, 20, 1, [=](double, double) { return z; }, 0);
  return mesh;
}

/// Everything within 10 m of the sensor, at the vehicle's origin.
VisibilityOptions allAround() {
  VisibilityOptions v;
  v.range_m = 10;
  v.minHeight_m = -100;
  v.maxHeight_m = 100;
  return v;
}

}  // namespace

TEST(VisibleSurface, FloorBelow_IsADisc) {
  const MeshQuery world(flatFloor(-6));
  const SurfaceRecall recall = VisibleSurface(world, restingAt({0, 0, 0}), allAround(), {}).recall();
  // Radius sqrt(100 - 36) = 8. Its edge of 50 m is sampled with one place for 0.0625 m²: some 3200 samples in all,
  // of which those at the edge are in or out by chance.
  EXPECT_NEAR(recall.area_m2, 64 * M_PI, 4);
  EXPECT_EQ(recall.within20cm, 0);
}

TEST(VisibleSurface, ElevationLimit_CutsTheNearPartOut) {
  const MeshQuery world(flatFloor(-6));
  VisibilityOptions v = allAround();
  v.maxElevation_rad = M_PI / 4;  // from 6 m outwards
  EXPECT_NEAR(VisibleSurface(world, restingAt({0, 0, 0}), v, {}).recall().area_m2, (64 - 36) * M_PI, 5);
}

TEST(VisibleSurface, Screen_CastsAShadow) {
  products::PlyMesh mesh = flatFloor(-6);
  // A tall screen through x = 1 hides all the floor beyond it, and shows its own near face.
  addBox(mesh, {1, -20, -6}, {1.1, 20, 10}, 1);
  VisibilityOptions v = allAround();
  v.maxHeight_m = -5.99;  // the floor alone
  const MeshQuery world(std::move(mesh));
  // Of the disc of radius 8 the part x < 1: half of it and the strip of 0 < x < 1, 15.96 m on average.
  EXPECT_NEAR(VisibleSurface(world, restingAt({0, 0, 0}), v, {}).recall().area_m2, 32 * M_PI + 15.96, 4);
}

TEST(VisibleSurface, MapOfHalfTheDisc_HasHalfTheRecall) {
  const MeshQuery world(flatFloor(-6));
  VisibleSurface surface(world, restingAt({0, 0, 0}), allAround(), {});
  for (double x = -9; x <= 0; x += 0.05)
    for (double y = -9; y <= 9; y += 0.05) surface.add({x, y, -5.92});
  const SurfaceRecall recall = surface.recall();
  // Points 8 cm above: none within 5 cm; within 10 cm up to 6 cm, within 20 cm up to 18 cm beyond x = 0 (16 m long),
  // of 201 m². A binomial share of 3200 samples has a standard deviation of 0.9 %.
  EXPECT_EQ(recall.within5cm, 0);
  EXPECT_NEAR(recall.within10cm, 0.5 + 0.06 * 16 / 201, 0.03);
  EXPECT_NEAR(recall.within20cm, 0.5 + 0.18 * 16 / 201, 0.03);
}

TEST(VisibleSurface, PointsOnEitherSideOfCellBorders_ReachAllSamples) {
  // One map point at each of many places: brute force over the samples' disc gives the expected share.
  const MeshQuery world(flatFloor(0));
  VisibilityOptions v = allAround();
  v.range_m = 5;
  VisibleSurface surface(world, restingAt({0, 0, 1}), v, {});
  // A lattice of 0.28 m leaves no place further than 0.198 m from a point.
  for (int i = -30; i <= 30; ++i)
    for (int k = -30; k <= 30; ++k) surface.add({0.28 * i, 0.28 * k, 0});
  EXPECT_EQ(surface.recall().within20cm, 1);
  // Of each lattice cell of 0.0784 m² a disc of 0.1 m lies within 10 cm.
  EXPECT_NEAR(surface.recall().within10cm, M_PI * 0.01 / 0.0784, 0.06);
}

TEST(VisibleSurface, EmptyPath_SeesNothing) {
  const MeshQuery world(flatFloor(-6));
  EXPECT_EQ(VisibleSurface(world, core::Trajectory(), allAround(), {}).recall().samples, 0u);
}

TEST(MeshQueryBlocked, LineThroughAndBesideABox_IsAndIsNot) {
  products::PlyMesh mesh;
  addBox(mesh, {0, 0, 0}, {1, 1, 1}, 0);
  const MeshQuery world(std::move(mesh));
  EXPECT_TRUE(world.blocked({-1, 0.5, 0.5}, {2, 0.4, 0.5}));
  EXPECT_FALSE(world.blocked({-1, 1.5, 0.5}, {2, 1.5, 0.5}));
  EXPECT_FALSE(world.blocked({-1, 0.5, 0.5}, {0, 0.5, 0.5}));  // ends on its near face
  EXPECT_TRUE(world.blocked({-1, 0.5, 0.5}, {1, 0.5, 0.5}));   // ends on its far face
  EXPECT_FALSE(world.blocked({-1, 0.5, 0.5}, {-0.5, 0.5, 0.5}));
}

TEST(FScore, PrecisionAndRecall_GiveTheHarmonicMean) {
  EXPECT_DOUBLE_EQ(fScore(0.5, 1), 2.0 / 3);
  EXPECT_EQ(fScore(0, 0), 0);
}
