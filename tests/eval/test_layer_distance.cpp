#include "s2s/eval/layer_distance.h"

#include <gtest/gtest.h>

#include "test_meshes.h"

using namespace s2s;
using namespace s2s::eval;

TEST(PointSample, FewPoints_AreAllKept) {
  PointSample sample(10);
  for (int i = 0; i < 10; ++i) sample.add({1.0 * i, 0, 0});
  EXPECT_EQ(sample.points().size(), 10u);
  EXPECT_EQ(sample.offered(), 10u);
}

TEST(PointSample, ManyPoints_AreSampledEvenlyInTimeAndOverBeams) {
  PointSample sample(20000);
  constexpr int kPoints = 640000, kBeams = 64;
  for (int i = 0; i < kPoints; ++i) sample.add({1.0 * i, 1.0 * (i % kBeams), 0});
  const auto points = sample.points();
  EXPECT_GE(points.size(), 9000u);
  EXPECT_LE(points.size(), 20000u);
  std::vector<double> ofBeam(kBeams, 0.0);
  double mean = 0;
  for (const auto& p : points) {
    ofBeam[static_cast<std::size_t>(p.y())] += 1;
    mean += p.x() / static_cast<double>(points.size());
  }
  // Binomial counts: five standard deviations of sqrt(n / 64), and of the mean of a uniform number.
  const double expected = static_cast<double>(points.size()) / kBeams;
  for (const double count : ofBeam) EXPECT_NEAR(count, expected, 5 * std::sqrt(expected));
  EXPECT_NEAR(mean, kPoints / 2.0, 5 * kPoints / std::sqrt(12.0 * static_cast<double>(points.size())));
}

TEST(LayerDistance, PointsAtKnownHeights_GiveTheirDistances) {
  products::PlyMesh mesh;
  addTerrain(
      mesh, -10, 10, -10, 10, 5, [](double, double) { return 2.0; }, 0);
  const MeshQuery query(std::move(mesh));
  std::vector<Eigen::Vector3d> points;
  for (const double height : {0.0, 0.04, -0.06, 0.15, 0.5}) points.emplace_back(1.3, -2.2, 2 + height);
  const LayerDistance layer = measureLayer(query, points, 500);
  EXPECT_EQ(layer.points, 500u);
  EXPECT_EQ(layer.sampled, 5u);
  EXPECT_NEAR(layer.distance_m.mean, 0.15, 1e-12);
  EXPECT_NEAR(layer.distance_m.median, 0.06, 1e-12);
  EXPECT_DOUBLE_EQ(layer.within5cm, 0.4);
  EXPECT_DOUBLE_EQ(layer.within10cm, 0.6);
  EXPECT_DOUBLE_EQ(layer.within20cm, 0.8);
}

TEST(LayerDistance, EmptyLayer_HasNoFigures) {
  products::PlyMesh mesh;
  addBox(mesh, {0, 0, 0}, {1, 1, 1}, 0);
  const LayerDistance layer = measureLayer(MeshQuery(std::move(mesh)), {}, 0);
  EXPECT_EQ(layer.distance_m.count, 0u);
  EXPECT_EQ(layer.within20cm, 0);
}
