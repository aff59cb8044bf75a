#include <gtest/gtest.h>

#include <set>

#include "s2s/sonar/feature_association.h"
#include "synthetic_pings.h"

namespace s2s::sonar {
namespace {

using test::kDeg;

PairGeometry crossedSonars() {
  PairGeometry g;
  g.T_h_v = core::isometryFromXyzYpr(0.02, -0.1, -0.15, 0, 0, M_PI / 2);
  g.aperture_h_rad = g.aperture_v_rad = 20 * kDeg;
  return g;
}

Feature featureOf(const Eigen::Vector3d& p_sonar, const core::Isometry& T_h_sonar, float intensity, int cluster) {
  const auto c = sonarCoordinates(p_sonar, obs::BearingModel::Azimuth);
  Feature f;
  f.range_m = c.range_m;
  f.bearing_rad = f.beamBearing_rad = c.bearing_rad;
  f.bearingSigma_rad = 0.15 * kDeg;
  f.p_h = T_h_sonar * pointAt({c.range_m, c.bearing_rad, 0}, obs::BearingModel::Azimuth);
  f.intensity = f.contextX = f.contextY = intensity;
  f.cluster = cluster;
  return f;
}

struct Scene {
  std::vector<Feature> h, v;
};

/// Each point gives a feature in both sonars; feature i of one belongs to feature (n - 1 - i) of the other.
Scene sceneOf(const std::vector<Eigen::Vector3d>& points_h, const PairGeometry& g) {
  Scene scene;
  for (const auto& p : points_h) scene.h.push_back(featureOf(p, core::Isometry::Identity(), 150, 0));
  for (auto p = points_h.rbegin(); p != points_h.rend(); ++p)
    scene.v.push_back(featureOf(g.T_h_v.inverse() * *p, g.T_h_v, 150, 0));
  return scene;
}

TEST(FeatureAssociation, PointsAtDistinctRanges_AreMatchedToThemselves) {
  const auto g = crossedSonars();
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 40; ++i) points.emplace_back(3 + 0.1 * i, 0.3 * std::sin(i), 0.3 * std::cos(1.7 * i));
  const auto scene = sceneOf(points, g);
  const auto result = associateFeatures(scene.h, scene.v, {{0, 0, 0}}, g, {});
  ASSERT_EQ(result.matches.size(), points.size());
  for (const auto& m : result.matches) EXPECT_EQ(m.horizontal + m.vertical, points.size() - 1);
}

TEST(FeatureAssociation, LiteralCost_IsDecidedByGreyLevels) {
  // Metres and grey levels added: a partner 3 m away with the same grey beats the true one that is 10 levels darker.
  const auto g = crossedSonars();
  auto scene = sceneOf({{3, 0, 0}, {6, 0, 0}}, g);
  const auto paint = [](Feature& f, float grey) { f.intensity = f.contextX = f.contextY = grey; };
  paint(scene.h[0], 120), paint(scene.h[1], 130);
  paint(scene.v[1], 130), paint(scene.v[0], 120);  // the true partners are v[1] and v[0]
  FeatureAssociationOptions options;
  options.cost = FeatureCost::Literal;
  const auto literal = associateFeatures(scene.h, scene.v, {{0, 0, 0}}, g, options);
  ASSERT_EQ(literal.matches.size(), 2u);
  EXPECT_EQ(literal.matches[0].vertical, 0u);
  const auto geometric = associateFeatures(scene.h, scene.v, {{0, 0, 0}}, g, {});
  ASSERT_EQ(geometric.matches.size(), 2u);
  EXPECT_EQ(geometric.matches[0].vertical, 1u);
}

TEST(FeatureAssociation, LiteralContexts_AreSwappedBetweenTheSonars) {
  const auto g = crossedSonars();
  auto scene = sceneOf({{4, 0, 0}, {4, 0.1, 0}}, g);
  for (auto& f : scene.h) f.contextX = 100, f.contextY = 200;
  for (auto& f : scene.v) f.contextX = 200, f.contextY = 100;
  FeatureAssociationOptions options;
  options.cost = FeatureCost::Literal;
  const auto result = associateFeatures(scene.h, scene.v, {{0, 0, 0}}, g, options);
  EXPECT_LT(result.cost, 0.1);  // only centimetres of x are left
}

TEST(FeatureAssociation, FeaturesOfClustersThatAreNotPaired_StayAlone) {
  const auto g = crossedSonars();
  auto scene = sceneOf({{4, 0, 0}}, g);
  EXPECT_TRUE(associateFeatures(scene.h, scene.v, {}, g, {}).matches.empty());
  scene.v[0].cluster = -1;
  EXPECT_TRUE(associateFeatures(scene.h, scene.v, {}, g, {}).matches.empty());
}

TEST(FeatureAssociation, PartnerBeyondTheRangeGate_IsRefused) {
  const auto g = crossedSonars();
  auto scene = sceneOf({{4, 0, 0}}, g);
  scene.v[0].range_m += 0.03;  // 2.1 sigma of both ranges
  EXPECT_EQ(associateFeatures(scene.h, scene.v, {{0, 0, 0}}, g, {}).matches.size(), 1u);
  scene.v[0].range_m += 0.03;  // 4.2 sigma
  EXPECT_TRUE(associateFeatures(scene.h, scene.v, {{0, 0, 0}}, g, {}).matches.empty());
}

TEST(FeatureAssociation, CrowdOnFewPartners_StaysOneToOne) {
  const auto g = crossedSonars();
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 60; ++i) points.push_back(pointAt({4, (i - 30) * 0.3 * kDeg, 0}, obs::BearingModel::Azimuth));
  auto scene = sceneOf(points, g);
  scene.v.resize(7);
  for (const std::size_t limit : {std::size_t{0}, std::size_t{100000}}) {  // auction, then optimal
    FeatureAssociationOptions options;
    options.maxResidual = 30;
    options.maxCost = 1e6;
    options.assignment.optimalEdges = limit;
    const auto result = associateFeatures(scene.h, scene.v, {{0, 0, 0}}, g, options);
    std::set<std::size_t> used;
    for (const auto& m : result.matches) EXPECT_TRUE(used.insert(m.vertical).second);
    EXPECT_EQ(result.matches.size(), 7u);
    EXPECT_LE(result.cost, 1.01 * result.lowerBound + 1e-3);
  }
}

TEST(FeatureAssociation, NoFeatures_GiveNoMatches) {
  EXPECT_TRUE(associateFeatures({}, {}, {}, crossedSonars(), {}).matches.empty());
}

}  // namespace
}  // namespace s2s::sonar
