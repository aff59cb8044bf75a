#include <gtest/gtest.h>

#include "fixed_random.h"
#include "s2s/graph/cloud.h"

using namespace s2s;
using namespace s2s::graph;
using graph::test::FixedRandom;

TEST(VoxelDownsample, PointsOfOneCube_BecomeTheirMean) {
  const Cloud thinned = voxelDownsample({{0.1F, 0.1F, 0.1F}, {0.3F, 0.1F, 0.1F}, {1.2F, 0.1F, 0.1F}}, 1.0);
  ASSERT_EQ(thinned.size(), 2U);
  EXPECT_TRUE(thinned[0].isApprox(Eigen::Vector3f(0.2F, 0.1F, 0.1F)));
  EXPECT_TRUE(thinned[1].isApprox(Eigen::Vector3f(1.2F, 0.1F, 0.1F)));
}

TEST(VoxelDownsample, CubesAcrossTheOrigin_StayApart) {
  EXPECT_EQ(voxelDownsample({{-0.1F, 0, 0}, {0.1F, 0, 0}}, 1.0).size(), 2U);
}

TEST(VoxelDownsample, NotFinitePoints_AreDropped) {
  EXPECT_EQ(voxelDownsample({{NAN, 0, 0}, {0, INFINITY, 0}, {1, 1, 1}}, 1.0).size(), 1U);
  EXPECT_TRUE(voxelDownsample({}, 1.0).empty());
}

TEST(VoxelDownsampleTo, ManyPoints_StayWithinTheLimit) {
  FixedRandom random(51);
  Cloud cloud;
  for (int n = 0; n < 20000; ++n) cloud.emplace_back(random.normal3(10).cast<float>());
  const Cloud thinned = voxelDownsampleTo(cloud, 0.1, 1000);
  EXPECT_LE(thinned.size(), 1000U);
  EXPECT_GT(thinned.size(), 300U);  // a volume, not a surface: the last enlargement may take more than needed
}

TEST(AppendTransformed, Points_AreMoved) {
  Cloud cloud{{1, 2, 3}};
  appendTransformed(core::isometryFromXyzYpr(10, 0, 0, M_PI / 2, 0, 0), {{1, 0, 0}}, cloud);
  ASSERT_EQ(cloud.size(), 2U);
  EXPECT_TRUE(cloud[1].isApprox(Eigen::Vector3f(10, 1, 0), 1e-6F));
}
