#include <gtest/gtest.h>

#include <cmath>

#include "s2s/map/keyframes.h"

namespace {

using s2s::core::Isometry;
using s2s::core::isometryFromXyzYpr;
using s2s::core::kNsPerSecond;
using s2s::core::TimeNs;
using s2s::map::Keyframes;
using s2s::map::PoseInterpolation;

TimeNs seconds(double s) { return s2s::core::durationNs(s); }

/// A vessel on a circle of 20 m radius at 1 m/s, rolling: position and attitude in closed form.
Isometry circle(double t) {
  const double angle = t / 20.0;
  return isometryFromXyzYpr(20 * std::sin(angle), 20 * (1 - std::cos(angle)), 0, angle, 0, 0.05 * std::sin(t));
}

Keyframes onCircle(const Isometry& T_map_odom) {
  Keyframes keyframes;
  for (int i = 0; i <= 10; ++i)
    keyframes.add({static_cast<std::uint64_t>(i), seconds(i), circle(i), T_map_odom * circle(i)});
  return keyframes;
}

double distance(const Isometry& a, const Isometry& b) {
  return (a.translation() - b.translation()).norm() + s2s::core::angleBetween(a.linear(), b.linear());
}

TEST(Keyframes, RigidCorrection_FollowsTheOdometryExactlyBetweenKeyframes) {
  const Isometry T_map_odom = isometryFromXyzYpr(500, -300, 2, 0.7, 0.01, -0.02);
  const Keyframes keyframes = onCircle(T_map_odom);
  for (double t = 0; t <= 10; t += 0.13) {
    const Isometry T = keyframes.poseAt(seconds(t), circle(t), PoseInterpolation::Odometry);
    // Two equal predictions are mixed: only rounding of products of a few hundred metres is left.
    EXPECT_LT(distance(T, T_map_odom * circle(t)), 1e-10) << t;
  }
}

TEST(Keyframes, ConstantVelocity_CutsTheChordOfTheAnalyticCircle) {
  const Keyframes keyframes = onCircle(Isometry::Identity());
  for (double t = 0.5; t < 10; t += 1.0) {
    const Isometry T = keyframes.poseAt(seconds(t), Isometry::Identity(), PoseInterpolation::ConstantVelocity);
    // Midway between two points 1 m of arc apart on a circle of radius 20: the chord's sagitta is R (1 - cos(1/40)).
    EXPECT_NEAR((T.translation() - circle(t).translation()).norm(), 20 * (1 - std::cos(1.0 / 40)), 1e-9) << t;
  }
}

TEST(Keyframes, StretchedCorrection_IsSharedOutByTime) {
  Keyframes keyframes;
  keyframes.add({0, seconds(0), isometryFromXyzYpr(0, 0, 0, 0, 0, 0), isometryFromXyzYpr(0, 0, 0, 0, 0, 0)});
  keyframes.add({1, seconds(2), isometryFromXyzYpr(2, 0, 0, 0, 0, 0), isometryFromXyzYpr(2, 0.4, 0, 0, 0, 0)});
  const Isometry T =
      keyframes.poseAt(seconds(0.5), isometryFromXyzYpr(0.3, 0, 0, 0, 0, 0), PoseInterpolation::Odometry);
  // The correction is a shift of 0 m at the first and 0.4 m at the second; a quarter of the way it is 0.1 m.
  EXPECT_NEAR(T.translation().x(), 0.3, 1e-12);
  EXPECT_NEAR(T.translation().y(), 0.1, 1e-12);
}

TEST(Keyframes, FarOdometryOrigin_ChangesNothing) {
  // The same local situation near the origin and 10 km away must give the same relative poses.
  const auto relative = [](const Isometry& T_far) {
    Keyframes keyframes;
    keyframes.add({0, seconds(0), T_far, Isometry::Identity()});
    keyframes.add(
        {1, seconds(1), T_far * isometryFromXyzYpr(1, 0, 0, 0, 0, 0), isometryFromXyzYpr(1, 0.1, 0, 0.1, 0, 0)});
    return keyframes.poseAt(seconds(0.5), T_far * isometryFromXyzYpr(0.5, 0, 0, 0, 0, 0), PoseInterpolation::Odometry);
  };
  const Isometry near = relative(Isometry::Identity());
  const Isometry far = relative(isometryFromXyzYpr(1e4, 1e4, 0, 0, 0, 0));
  EXPECT_LT(distance(near, far), 1e-10);  // rounding of 1e4 m in double is 2e-12
}

TEST(Keyframes, OutsideTheKeyframes_TheNearestOneCarriesTheOdometryOn) {
  const Isometry T_map_odom = isometryFromXyzYpr(5, 6, 7, 0.3, 0, 0);
  const Keyframes keyframes = onCircle(T_map_odom);
  for (const auto mode : {PoseInterpolation::Odometry, PoseInterpolation::ConstantVelocity})
    for (const double t : {-3.0, 14.0})
      EXPECT_LT(distance(keyframes.poseAt(seconds(t), circle(t), mode), T_map_odom * circle(t)), 1e-12) << t;
}

TEST(Keyframes, NoKeyframes_MapIsOdometry) {
  EXPECT_LT(distance(Keyframes().poseAt(0, circle(3), PoseInterpolation::Odometry), circle(3)), 1e-15);
}

TEST(Keyframes, EqualTimes_GiveTheLaterOfThemAndNoDivisionByZero) {
  Keyframes keyframes;
  keyframes.add({7, kNsPerSecond, Isometry::Identity(), isometryFromXyzYpr(1, 0, 0, 0, 0, 0)});
  keyframes.add({8, kNsPerSecond, Isometry::Identity(), isometryFromXyzYpr(2, 0, 0, 0, 0, 0)});
  EXPECT_DOUBLE_EQ(
      keyframes.poseAt(kNsPerSecond, Isometry::Identity(), PoseInterpolation::ConstantVelocity).translation().x(), 2);
}

TEST(Keyframes, LateKeyframe_IsSortedInAndKeepsItsId) {
  Keyframes keyframes;
  keyframes.add({10, seconds(0), Isometry::Identity(), Isometry::Identity()});
  keyframes.add({30, seconds(2), Isometry::Identity(), Isometry::Identity()});
  keyframes.add({20, seconds(1), Isometry::Identity(), Isometry::Identity()});
  EXPECT_EQ(keyframes.setPoses({{20, isometryFromXyzYpr(0, 9, 0, 0, 0, 0)}, {99, Isometry::Identity()}}), 1u);
  ASSERT_NE(keyframes.find(20), nullptr);
  EXPECT_EQ(keyframes.all()[1].id, 20u);
  EXPECT_DOUBLE_EQ(keyframes.find(20)->T_map_vehicle.translation().y(), 9);
}

TEST(Keyframes, TakenId_IsRefused) {
  Keyframes keyframes;
  EXPECT_TRUE(keyframes.add({1, 0, Isometry::Identity(), Isometry::Identity()}));
  EXPECT_FALSE(keyframes.add({1, 5, Isometry::Identity(), Isometry::Identity()}));
  EXPECT_EQ(keyframes.all().size(), 1u);
}

TEST(Keyframes, UnknownId_Throws) { EXPECT_THROW(Keyframes().poseFrom(3, Isometry::Identity()), std::out_of_range); }

}  // namespace
