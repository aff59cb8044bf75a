#include "s2s/eval/mesh_query.h"

#include <gtest/gtest.h>

#include <random>

#include "test_meshes.h"

using namespace s2s;
using namespace s2s::eval;

namespace {

/// Distance of a point from the surface of an axis-aligned box.
double distanceToBox(const Eigen::Vector3d& p, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  const Eigen::Vector3d outside = (low - p).cwiseMax(p - high);
  if (outside.maxCoeff() <= 0) return -outside.maxCoeff();
  return outside.cwiseMax(0).norm();
}

}  // namespace

TEST(MeshQuery, PointsAroundACube_HaveTheClosedFormDistance) {
  const Eigen::Vector3d low(99, -51, -4), high(101, -48, 3);
  products::PlyMesh mesh;
  addBox(mesh, low, high, 5);
  const MeshQuery query(std::move(mesh));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> x(95, 105), y(-55, -44), z(-8, 7);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d p(x(random), y(random), z(random));
    const auto nearest = query.nearest(p, 100);
    ASSERT_TRUE(nearest.has_value());
    // The distance itself is computed in double precision.
    ASSERT_NEAR(nearest->distance_m, distanceToBox(p, low, high), 1e-12) << p.transpose();
  }
}

TEST(MeshQuery, PointsAroundASphere_LieAtTheirRadius) {
  const Eigen::Vector3d centre(10, 20, -5);
  const MeshQuery query(sphereMesh(centre, 2, 200));
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  // The facets stay within r (1 - cos(pi / 400)) sqrt(2)-ish below the sphere: half a facet's diagonal is 0.9°, so
  // r (1 - cos 0.65°) = 0.00013 m.
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d direction = Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
    for (const double radius : {0.5, 1.9, 2.3, 9.0})
      ASSERT_NEAR(query.nearest(centre + radius * direction, 100)->distance_m, std::abs(radius - 2), 2e-4);
  }
}

TEST(MeshQuery, ManyTriangles_EqualBruteForce) {
  products::PlyMesh mesh;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-150, 150), size(-3, 3);
  for (std::uint32_t i = 0; i < 300; ++i) {
    const Eigen::Vector3d a(place(random), place(random), size(random));
    mesh.vertices.push_back(a);
    for (int k = 0; k < 2; ++k)
      mesh.vertices.emplace_back(a + Eigen::Vector3d(size(random), size(random), size(random)));
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const MeshQuery query(mesh);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d p(place(random), place(random), size(random));
    double best = 1e9;
    for (const auto& [a, b, c] : mesh.triangles)
      best =
          std::min(best, (p - closestPointOnTriangle(p, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c])).norm());
    ASSERT_NEAR(query.nearest(p, 1000)->distance_m, best, 1e-12);
  }
}

TEST(MeshQuery, FartherThanTheLimit_IsNothing) {
  products::PlyMesh mesh;
  addBox(mesh, {0, 0, 0}, {1, 1, 1}, 0);
  const MeshQuery query(std::move(mesh));
  EXPECT_FALSE(query.nearest({5, 0.5, 0.5}, 3.9).has_value());
  EXPECT_TRUE(query.nearest({5, 0.5, 0.5}, 4.1).has_value());
}

TEST(MeshQuery, NearestTriangle_TellsItsObject) {
  products::PlyMesh mesh;
  addBox(mesh, {0, 0, 0}, {1, 1, 1}, 7);
  addBox(mesh, {10, 0, 0}, {11, 1, 1}, 8);
  const MeshQuery query(std::move(mesh));
  EXPECT_EQ(query.mesh().object[query.nearest({2, 0.5, 0.5}, 100)->triangle], 7);
  EXPECT_EQ(query.mesh().object[query.nearest({9, 0.5, 0.5}, 100)->triangle], 8);
}

TEST(MeshQuery, TopHeight_IsTheUppermostSurface) {
  products::PlyMesh mesh;
  const auto slope = [](double x, double y) { return -4 + 0.05 * x - 0.02 * y; };
  addTerrain(mesh, -150, 150, -40, 40, 1, slope, 0);
  addBox(mesh, {10, 10, -6}, {11, 11, -2}, 1);
  const MeshQuery query(std::move(mesh));
  // The ray's place and the barycentric coordinates are single precision: 150 m * 6e-8 * slope, and heights 4 m * 6e-8.
  EXPECT_NEAR(*query.topHeight_m(-123.4, 33.3), slope(-123.4, 33.3), 2e-6);
  EXPECT_NEAR(*query.topHeight_m(10.5, 10.5), -2, 1e-6);
  EXPECT_FALSE(query.topHeight_m(151, 0).has_value());
}

TEST(MeshQuery, RaysThroughSharedEdgesAndCorners_Hit) {
  products::PlyMesh mesh;
  addTerrain(
      mesh, -10, 10, -10, 10, 1, [](double, double) { return -3.0; }, 0);
  const MeshQuery query(std::move(mesh));
  for (int x = -9; x <= 9; ++x)
    for (int y = -9; y <= 9; ++y) {
      EXPECT_TRUE(query.topHeight_m(x, y).has_value()) << x << ' ' << y;
      EXPECT_TRUE(query.topHeight_m(x + 0.5, y + 0.5).has_value()) << x << ' ' << y;
    }
}
