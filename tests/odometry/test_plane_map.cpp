#include <gtest/gtest.h>

#include "s2s/odometry/downsample.h"
#include "s2s/odometry/plane_map.h"
#include "synthetic.h"

namespace s2s::odometry {
namespace {

using Eigen::Vector3d;

std::vector<Vector3d> noisyPlane(const Vector3d& normal, double distance, double sigma, int count, std::uint64_t seed) {
  synthetic::Random random(seed);
  const Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
  std::vector<Vector3d> points;
  for (int i = 0; i < count; ++i)
    points.emplace_back((8 * random.uniform() - 4) * u + (8 * random.uniform() - 4) * v +
                        (distance + sigma * random.gaussian()) * normal);
  return points;
}

TEST(PlaneMap, NoisyPlane_IsFoundWithItsDistance) {
  const Vector3d normal = Vector3d(1, 2, 3).normalized();
  PlaneMap map{PlaneMapOptions()};
  map.insert(noisyPlane(normal, 0.7, 0.01, 20000, 1));
  PlaneMatch match;
  int found = 0;
  for (const auto& point : noisyPlane(normal, 0.75, 0, 200, 2)) {
    if (!map.match(point, match)) continue;
    ++found;
    EXPECT_GT(std::abs(match.normal.dot(normal)), 0.999);
    // 1 cm noise over some tens of points: a few millimetres, and more at a voxel's edge.
    EXPECT_NEAR(std::abs(match.distance_m), 0.05, 0.012);
  }
  EXPECT_GT(found, 150);
}

TEST(PlaneMap, DistanceErrors_AreAsLargeAsStated) {
  const Vector3d normal = Vector3d(0.2, -0.3, 1).normalized();
  PlaneMap map{PlaneMapOptions()};
  map.insert(noisyPlane(normal, 0.7, 0.01, 6000, 3));
  PlaneMatch match;
  double sum = 0;
  int count = 0;
  for (const auto& point : noisyPlane(normal, 0.7, 0, 2000, 4))
    if (map.match(point, match)) {
      sum += match.distance_m * match.distance_m / match.variance_m2;
      ++count;
    }
  ASSERT_GT(count, 1000);
  // Ideally 1. Points in one voxel share its plane, so the mean scatters, and the tilt is stated for the worse axis.
  EXPECT_GT(sum / count, 0.4);
  EXPECT_LT(sum / count, 1.4);
}

TEST(PlaneMap, ScatteredPoints_AreNoPlane) {
  synthetic::Random random(5);
  std::vector<Vector3d> points;
  for (int i = 0; i < 20000; ++i) points.emplace_back(6 * random.uniform(), 6 * random.uniform(), 6 * random.uniform());
  PlaneMap map{PlaneMapOptions()};
  map.insert(points);
  PlaneMatch match;
  int found = 0;
  for (int i = 0; i < 1000; ++i)
    found += map.match({6 * random.uniform(), 6 * random.uniform(), 6 * random.uniform()}, match);
  // Few points may lie flat by chance; most voxels must not.
  EXPECT_LT(found, 50);
}

TEST(PlaneMap, OneScanLine_IsNoPlane) {
  std::vector<Vector3d> points;
  for (int i = 0; i < 500; ++i) points.emplace_back(0.01 * i, 0.2, 0.3);
  PlaneMap map{PlaneMapOptions()};
  map.insert(points);
  PlaneMatch match;
  EXPECT_FALSE(map.match({1.0, 0.2, 0.3}, match));
}

TEST(PlaneMap, ForgetBeyond_DropsFarVoxelsOnly) {
  PlaneMap map{PlaneMapOptions()};
  auto points = noisyPlane(Vector3d::UnitZ(), 0, 0.01, 5000, 6);
  map.insert(points);
  const std::size_t near = map.size();
  for (auto& point : points) point.x() += 300;
  map.insert(points);
  EXPECT_GT(map.size(), near);
  map.forgetBeyond(Vector3d::Zero(), 100);
  EXPECT_EQ(map.size(), near);
  PlaneMatch match;
  EXPECT_TRUE(map.match({0.5, 0.5, 0}, match));
  EXPECT_FALSE(map.match({300.5, 0.5, 0}, match));
}

TEST(PlaneMap, EmptyMap_MatchesNothing) {
  const PlaneMap map{PlaneMapOptions()};
  PlaneMatch match;
  EXPECT_TRUE(map.empty());
  EXPECT_FALSE(map.match({0, 0, 0}, match));
}

TEST(OnePerCube, Points_AreThinnedToOneInEachCube) {
  synthetic::Random random(7);
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 5000; ++i)
    points.emplace_back(
        Vector3d(4 * random.uniform() - 2, 4 * random.uniform() - 2, 2 * random.uniform()).cast<float>());
  const auto kept = onePerCube(points, 0.5);
  EXPECT_EQ(kept.size(), 8U * 8U * 4U);  // 5000 points leave none of the 256 cubes empty
  EXPECT_EQ(kept.front(), 0U);
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  EXPECT_TRUE(onePerCube({}, 0.5).empty());
}

}  // namespace
}  // namespace s2s::odometry
