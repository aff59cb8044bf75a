#include <gtest/gtest.h>

#include "s2s/sonar/cluster_association.h"

namespace s2s::sonar {
namespace {

std::vector<Feature> featuresAt(const std::vector<std::vector<double>>& clusters) {
  std::vector<Feature> features;
  for (std::size_t c = 0; c < clusters.size(); ++c)
    for (const double x : clusters[c]) {
      Feature f;
      f.p_h.x() = x;
      f.cluster = static_cast<int>(c);
      features.push_back(f);
    }
  return features;
}

TEST(ClusterAssociation, Descriptor_IsMeanVarianceAndLimitsOfX) {
  auto features = featuresAt({{2, 3, 7}});
  features.push_back({});  // noise: cluster -1
  const auto clusters = describeClusters(features);
  ASSERT_EQ(clusters.size(), 1u);
  EXPECT_DOUBLE_EQ(clusters[0].mean_m, 4);
  EXPECT_NEAR(clusters[0].variance_m2, 14.0 / 3, 1e-12);
  EXPECT_EQ(clusters[0].min_m, 2);
  EXPECT_EQ(clusters[0].max_m, 7);
  EXPECT_EQ(clusters[0].size, 3u);
}

TEST(ClusterAssociation, LiteralCost_AddsVariancesNormalisedCostDeviations) {
  const ClusterDescriptor a{4, 4, 1, 7, 10}, b{5, 1, 3, 7, 10};
  EXPECT_NEAR(clusterCost(a, b, ClusterCost::Literal), std::sqrt(1.0 + 9 + 4), 1e-12);
  EXPECT_NEAR(clusterCost(a, b, ClusterCost::Normalised), std::sqrt(1.0 + 1 + 4), 1e-12);
}

TEST(ClusterAssociation, Nearest_PairsEachHorizontalClusterWithItsBest) {
  const auto h = describeClusters(featuresAt({{2, 3}, {6, 7}, {6.1, 7.1}}));
  const auto v = describeClusters(featuresAt({{6.05, 7.05}, {2.1, 3.1}}));
  const auto pairs = associateClusters(h, v, {});
  ASSERT_EQ(pairs.size(), 3u);
  EXPECT_EQ(pairs[0].vertical, 1);
  EXPECT_EQ(pairs[1].vertical, 0);
  EXPECT_EQ(pairs[2].vertical, 0);
}

TEST(ClusterAssociation, Both_AlsoServesTheVerticalClustersLeftOver) {
  const auto h = describeClusters(featuresAt({{2, 8}}));
  const auto v = describeClusters(featuresAt({{2, 8.2}, {4, 5}}));
  ClusterAssociationOptions options;
  EXPECT_EQ(associateClusters(h, v, options).size(), 1u);
  options.pairing = ClusterPairing::Both;
  EXPECT_EQ(associateClusters(h, v, options).size(), 2u);
  options.pairing = ClusterPairing::Overlap;
  EXPECT_EQ(associateClusters(h, v, options).size(), 2u);
}

TEST(ClusterAssociation, ClustersAtDifferentDistances_AreNotPaired) {
  const auto h = describeClusters(featuresAt({{2, 3}})), v = describeClusters(featuresAt({{3.3, 5}}));
  EXPECT_TRUE(associateClusters(h, v, {}).empty());
}

TEST(ClusterAssociation, NoClusters_GiveNoPairs) {
  EXPECT_TRUE(describeClusters({}).empty());
  EXPECT_TRUE(associateClusters({}, {}, {}).empty());
}

}  // namespace
}  // namespace s2s::sonar
