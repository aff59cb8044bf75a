#include "s2s/eval/trajectory_error.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace s2s;
using namespace s2s::eval;

namespace {

const core::Isometry kMotion = core::isometryFromXyzYpr(310.5, -72.25, 4.5, 2.1, -0.4, 0.3);

core::TimeNs at(double seconds) { return 1'733'400'000 * core::kNsPerSecond + core::durationNs(seconds); }

/// A circle of 20 m radius about the origin at 1 m/s, heading along it.
core::Isometry onCircle(double seconds) {
  const double angle = seconds / 20;
  return core::isometryFromXyzYpr(20 * std::cos(angle), 20 * std::sin(angle), 0, angle + M_PI / 2, 0, 0);
}

/// Straight along x at 1 m/s, ten poses a second.
std::vector<PosePair> straightWithDrift(double seconds, double scale, double yawRate_radps) {
  std::vector<PosePair> pairs;
  for (int i = 0; i <= static_cast<int>(10 * seconds); ++i) {
    const double t = 0.1 * i;
    pairs.push_back({at(t), core::isometryFromXyzYpr(t, 0, 0, 0, 0, 0),
                     core::isometryFromXyzYpr(scale * t, 0, 0, yawRate_radps * t, 0, 0)});
  }
  return pairs;
}

}  // namespace

TEST(PairByTime, StampsBetweenReferencePoses_GetTheInterpolatedPose) {
  core::Trajectory reference, estimate;
  for (int i = 0; i <= 10; ++i) reference.append(at(0.01 * i), core::isometryFromXyzYpr(0.01 * i, 0, 0, 0, 0, 0));
  estimate.append(at(-1), core::Isometry::Identity());
  estimate.append(at(0.0337), core::Isometry::Identity());
  estimate.append(at(5), core::Isometry::Identity());
  const auto pairs = pairByTime(reference, estimate);
  ASSERT_EQ(pairs.size(), 1u);                                       // the others lie outside the reference
  EXPECT_NEAR(pairs[0].T_ref_body.translation().x(), 0.0337, 1e-9);  // times have 1 ns
}

TEST(PairByTime, GapInTheReference_GivesNoPair) {
  core::Trajectory reference, estimate;
  reference.append(at(0), core::Isometry::Identity());
  reference.append(at(1), core::Isometry::Identity());
  estimate.append(at(0.5), core::Isometry::Identity());
  EXPECT_TRUE(pairByTime(reference, estimate, 0.1).empty());
  EXPECT_EQ(pairByTime(reference, estimate, 2).size(), 1u);
}

TEST(AbsoluteError, SamePathInAnotherFrame_IsZero) {
  std::vector<PosePair> pairs;
  for (int i = 0; i < 200; ++i) pairs.push_back({at(0.5 * i), onCircle(0.5 * i), kMotion * onCircle(0.5 * i)});
  for (const auto alignment : {TrajectoryAlignment::Positions, TrajectoryAlignment::Poses}) {
    const AbsoluteError error = absoluteError(pairs, alignment);
    // Rounding of coordinates of 300 m, and of an angle near zero taken from a rotation matrix (its square root).
    EXPECT_LT(error.translation_m.max, 1e-10);
    EXPECT_LT(error.rotation_rad.max, 1e-7);
    EXPECT_LT((error.T_ref_est.inverse().matrix() - kMotion.matrix()).norm(), 1e-9);
  }
}

TEST(AbsoluteError, OffsetsUpAndDownInTurn_AreTheError) {
  // Along a closed circle, +0.1 m and -0.1 m in turn have no mean and no moment: the alignment cannot absorb them,
  // so each error is exactly 0.1 m.
  std::vector<PosePair> pairs;
  const int n = 400;
  for (int i = 0; i < n; ++i) {
    const core::Isometry T = onCircle(40 * M_PI * i / n);
    core::Isometry up = T;
    up.translation().z() += i % 2 == 0 ? 0.1 : -0.1;
    pairs.push_back({at(0.1 * i), T, up});
  }
  const AbsoluteError error = absoluteError(pairs, TrajectoryAlignment::Positions);
  EXPECT_NEAR(error.translation_m.rmse, 0.1, 1e-12);
  EXPECT_NEAR(error.translation_m.min, 0.1, 1e-12);
  EXPECT_NEAR(error.translation_m.max, 0.1, 1e-12);
}

TEST(AbsoluteError, LargerCircle_LeavesTheDifferenceOfTheRadii) {
  // No scale is estimated: a circle of 20.2 m about the same centre is 0.2 m off everywhere.
  std::vector<PosePair> pairs;
  for (int i = 0; i < 360; ++i) {
    const core::Isometry T = onCircle(40 * M_PI * i / 360);
    core::Isometry wide = T;
    wide.translation() *= 1.01;
    pairs.push_back({at(i), T, kMotion * wide});
  }
  EXPECT_NEAR(absoluteError(pairs, TrajectoryAlignment::Positions).translation_m.mean, 0.2, 1e-10);
}

TEST(RelativeError, ConstantDrift_GivesItsShareOfEachStep) {
  const auto pairs = straightWithDrift(60, 1.02, 0);
  // One frame is 0.1 m, its error 2 % of that.
  EXPECT_NEAR(relativeErrorOverFrames(pairs, 1).translation_m.max, 0.002, 1e-12);
  EXPECT_EQ(relativeErrorOverFrames(pairs, 1).translation_m.count, 600u);
  EXPECT_NEAR(relativeErrorOverFrames(pairs, 10).translation_m.mean, 0.02, 1e-12);
  EXPECT_EQ(relativeErrorOverFrames(pairs, 10).translation_m.count, 60u);
}

TEST(RelativeError, OverDistance_CountsTheEstimatedPath) {
  // The estimate runs 0.102 m a frame, so 5 m need 50 frames (5.1 m); each stretch is off by 0.1 m.
  const RelativeError error = relativeErrorOverDistance(straightWithDrift(60, 1.02, 0), 5);
  EXPECT_NEAR(error.translation_m.mean, 0.1, 1e-9);
  EXPECT_NEAR(error.translation_m.std, 0, 1e-9);
  EXPECT_EQ(error.translation_m.count, 11u);  // 600 frames: marks at 50, 100, … 600, and the first only begins
}

TEST(RelativeError, YawDrift_ShowsInTheRotation) {
  const RelativeError error = relativeErrorOverFrames(straightWithDrift(20, 1, 0.01), 10);
  EXPECT_NEAR(error.rotation_rad.mean, 0.01, 1e-9);
}

TEST(RelativeError, AnotherFrame_ChangesNothing) {
  auto pairs = straightWithDrift(20, 1.02, 0.01);
  const RelativeError before = relativeErrorOverFrames(pairs, 7);
  for (auto& pair : pairs) pair.T_est_body = kMotion * pair.T_est_body;
  const RelativeError after = relativeErrorOverFrames(pairs, 7);
  EXPECT_NEAR(before.translation_m.rmse, after.translation_m.rmse, 1e-11);
  EXPECT_NEAR(before.rotation_rad.rmse, after.rotation_rad.rmse, 1e-7);
}

TEST(RelativeError, PathShorterThanTheDistance_HasNoPairs) {
  EXPECT_EQ(relativeErrorOverDistance(straightWithDrift(3, 1, 0), 5).translation_m.count, 0u);
  EXPECT_EQ(relativeErrorOverFrames({}, 1).translation_m.count, 0u);
}

TEST(SegmentError, TwoPerCentTooLong_IsTwoPerCent) {
  const SegmentError error = segmentError(straightWithDrift(150, 1.02, 0), 100);
  // Segments end at the first pose at or past 100 m; sums of 0.1 m steps may round to just below and take one more
  // pose: 0.1 % of the length.
  EXPECT_NEAR(error.translation_share, 0.02, 0.02 * 0.0011);
  EXPECT_GE(error.count, 50u);  // starts at 0, 1, … 50 m
  EXPECT_LE(error.count, 51u);
}

TEST(SegmentError, YawDriftPerMetre_IsTheRotationError) {
  EXPECT_NEAR(segmentError(straightWithDrift(150, 1, 0.0005), 100).rotation_radpm, 0.0005, 0.0005 * 0.0011);
}

TEST(SegmentError, PathTooShort_HasNone) {
  const SegmentError error = segmentError(straightWithDrift(99, 1, 0), 100);
  EXPECT_EQ(error.count, 0u);
  EXPECT_EQ(error.translation_share, 0);
}
