#include "s2s/core/trajectory.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace s2s;
using core::Isometry;
using core::Trajectory;

namespace {

constexpr core::TimeNs kSecond = core::kNsPerSecond;

/// A circle of 10 m radius at 0.1 rad/s with the nose along the tangent.
Isometry onCircle(double t_s) {
  const double angle = 0.1 * t_s;
  return core::isometryFromXyzYpr(10 * std::cos(angle), 10 * std::sin(angle), 0, angle + M_PI / 2, 0, 0);
}

}  // namespace

TEST(Trajectory, UnsortedPoses_AreSortedAndLastOfEqualTimesStays) {
  const Trajectory trajectory({{3, onCircle(3)}, {1, onCircle(0)}, {2, onCircle(2)}, {1, onCircle(1)}});
  ASSERT_EQ(trajectory.size(), 3u);
  EXPECT_EQ(trajectory.front().time, 1);
  EXPECT_TRUE(trajectory.front().T.isApprox(onCircle(1)));
  EXPECT_EQ(trajectory.back().time, 3);
}

TEST(Trajectory, AppendNotLater_IsRefused) {
  Trajectory trajectory;
  EXPECT_TRUE(trajectory.append(10, Isometry::Identity()));
  EXPECT_FALSE(trajectory.append(10, Isometry::Identity()));
  EXPECT_FALSE(trajectory.append(9, Isometry::Identity()));
  EXPECT_EQ(trajectory.size(), 1u);
}

TEST(Trajectory, AtAKnownTime_IsThatPoseExactly) {
  const Trajectory trajectory({{0, onCircle(0)}, {kSecond, onCircle(1)}});
  EXPECT_TRUE(trajectory.at(kSecond)->isApprox(onCircle(1), 1e-15));
  EXPECT_TRUE(trajectory.at(0)->isApprox(onCircle(0), 1e-15));
}

TEST(Trajectory, BetweenPosesOfACircle_StaysNearIt) {
  std::vector<core::TimedPose> poses;
  for (int i = 0; i <= 10; ++i) poses.push_back({i * kSecond, onCircle(i)});
  const Trajectory trajectory(poses);
  for (double t_s = 0.05; t_s < 10; t_s += 0.1) {
    const auto T = trajectory.at(core::durationNs(t_s));
    ASSERT_TRUE(T.has_value());
    // The chord of 0.1 rad on a 10 m circle is at most r (1 - cos 0.05) = 12.5 mm off it; the heading is linear in
    // time.
    EXPECT_LT((T->translation() - onCircle(t_s).translation()).norm(), 0.0126);
    EXPECT_LT(core::angleBetween(T->linear(), onCircle(t_s).linear()), 1e-9);
  }
}

TEST(Trajectory, OutsideOrEmpty_IsNothing) {
  EXPECT_FALSE(Trajectory().at(0).has_value());
  const Trajectory trajectory({{10, onCircle(0)}, {20, onCircle(1)}});
  EXPECT_FALSE(trajectory.at(9).has_value());
  EXPECT_FALSE(trajectory.at(21).has_value());
}

TEST(Trajectory, GapWiderThanAllowed_IsNothingButItsEndsAreThere) {
  const Trajectory trajectory({{0, onCircle(0)}, {2 * kSecond, onCircle(2)}});
  EXPECT_FALSE(trajectory.at(kSecond, 1.9).has_value());
  EXPECT_TRUE(trajectory.at(kSecond, 2.1).has_value());
  EXPECT_TRUE(trajectory.at(kSecond, 0).has_value());
  EXPECT_TRUE(trajectory.at(2 * kSecond, 1.9).has_value());
}

TEST(Trajectory, ForgetBefore_KeepsWhatAtNeeds) {
  Trajectory trajectory;
  for (int i = 0; i < 5; ++i) trajectory.append(i * 10, onCircle(i));
  trajectory.forgetBefore(25);
  EXPECT_EQ(trajectory.front().time, 20);
  EXPECT_TRUE(trajectory.at(25).has_value());
  trajectory.forgetBefore(20);
  EXPECT_EQ(trajectory.size(), 3u);
  trajectory.forgetBefore(1000);
  EXPECT_EQ(trajectory.size(), 1u);
}

TEST(Trajectory, Length_IsTheSumOfSteps) {
  const Trajectory trajectory({{0, core::isometryFromXyzYpr(0, 0, 0, 0, 0, 0)},
                               {1, core::isometryFromXyzYpr(3, 4, 0, 0, 0, 0)},
                               {2, core::isometryFromXyzYpr(3, 4, 12, 0, 0, 0)}});
  EXPECT_DOUBLE_EQ(trajectory.length_m(), 17);
  EXPECT_EQ(Trajectory().length_m(), 0);
}
