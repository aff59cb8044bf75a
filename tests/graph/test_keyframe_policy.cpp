#include <gtest/gtest.h>

#include "s2s/graph/keyframe_policy.h"

using namespace s2s;
using namespace s2s::graph;

namespace {
core::Isometry at(double x, double yaw, double roll = 0) { return core::isometryFromXyzYpr(x, 0, 0, yaw, 0, roll); }
}  // namespace

TEST(KeyframePolicy, FirstPose_IsAKeyframe) { EXPECT_TRUE(KeyframePolicy().accept(at(3, 1))); }

TEST(KeyframePolicy, ThresholdsFromBothSides_AreThePapers) {
  KeyframePolicy policy;
  policy.accept(at(0, 0));
  EXPECT_FALSE(policy.accept(at(0.999, 0)));
  EXPECT_TRUE(policy.accept(at(1.001, 0)));
  EXPECT_FALSE(policy.accept(at(1.001, 0.0499)));
  EXPECT_TRUE(policy.accept(at(1.001, 0.0501)));
}

TEST(KeyframePolicy, SmallStepsAddUp_FromTheLastKeyframe) {
  KeyframePolicy policy;
  int keyframes = 0;
  for (int n = 0; n <= 100; ++n) keyframes += policy.accept(at(0.3 * n, 0)) ? 1 : 0;
  EXPECT_EQ(keyframes, 26);  // every fourth of 101 steps: 1.2 m
}
