#include "s2s/graph/acoustic_registration.h"

#include <gtest/gtest.h>

#include "synthetic_seabed.h"

using namespace s2s;
using namespace s2s::graph;
using namespace s2s::graph::test;

namespace {

constexpr double kNoise_m = 0.03;
const core::Isometry kA = core::isometryFromXyzYpr(5, 3, 0.02, 0.4, 0.01, -0.02);
const core::Isometry kMotion = core::isometryFromXyzYpr(0.6, -0.4, -0.05, 1.5, 0.02, 0.03);

/// The covariance of the registration alone, for comparison with its errors.
AcousticRegistrationOptions withoutFloor() {
  AcousticRegistrationOptions options;
  options.floorHorizontal_m = options.floorHeight_m = 1e-3;
  options.floorTilt_rad = options.floorYaw_rad = 1e-4;
  return options;
}

AcousticRegistrationResult registered(const AcousticCloud& a, const AcousticCloud& b, const core::Isometry& T_initial,
                                      const AcousticRegistrationOptions& options, double priorSigma_m = 0.1) {
  return registerAcoustic(AcousticTarget(a, options), thinned(b, options.voxel_m, options.leastSigma_m), T_initial,
                          priorSigma_m, options);
}

double nees(const core::Isometry& truth, const AcousticRegistrationResult& result) {
  const core::Vector6 error = difference(truth, result.T_target_source);
  return error.dot(result.covariance.inverse() * error);
}

}  // namespace

TEST(AcousticRegistration, UnevenSeabedSeenTwice_MotionIsFoundWithinItsCovariance) {
  const SyntheticSeabed seabed(0.06, 1);
  FixedRandom random(2);
  for (int trial = 0; trial < 10; ++trial) {
    const AcousticCloud a = seabed.seen(kA, 8, 6000, kNoise_m, random);
    const AcousticCloud b = seabed.seen(kA * kMotion, 6, 4000, kNoise_m, random);
    const auto result = registered(a, b, kMotion * random.pose(0.1, 0.01), withoutFloor());
    ASSERT_EQ(result.fit, AcousticFit::good) << trial;
    EXPECT_EQ(result.degenerate, 0);
    // Slopes of about 0.2 and 3 cm of noise, averaged over hundreds of cells.
    EXPECT_LT(difference(kMotion, result.T_target_source).head<3>().norm(), 0.05) << trial;
    EXPECT_LT(nees(kMotion, result), 22.5) << trial;  // 6 degrees of freedom, 99.9 %
    // Honest is not the same as worthless: centimetres horizontally, less in height.
    EXPECT_LT(std::sqrt(result.covariance(0, 0)), 0.15);
    EXPECT_LT(std::sqrt(result.covariance(2, 2)), 0.03);
  }
}

TEST(AcousticRegistration, FlatSeabed_TellsHeightRollAndPitchOnly) {
  const SyntheticSeabed flat(0, 1);
  FixedRandom random(3);
  const AcousticCloud a = flat.seen(kA, 8, 6000, kNoise_m, random);
  const AcousticCloud b = flat.seen(kA * kMotion, 6, 4000, kNoise_m, random);
  const core::Isometry T_initial = kMotion * core::isometryFromXyzYpr(0.2, 0.1, 0.1, 0.05, 0.02, -0.02);
  const auto result = registered(a, b, T_initial, withoutFloor());
  ASSERT_EQ(result.fit, AcousticFit::good);
  EXPECT_EQ(result.degenerate, 3);
  const core::Vector6 error = difference(kMotion, result.T_target_source);
  EXPECT_LT(std::abs(error[2]), 0.02);                         // thousands of points with 3 cm
  EXPECT_LT(error.segment<2>(3).cwiseAbs().maxCoeff(), 0.01);  // over 6 m
  // The way along the seabed and the heading stay as they were given, and nothing is claimed about them.
  EXPECT_LT((error.head<2>() - Eigen::Vector2d(0.2, 0.1)).norm(), 0.03);
  EXPECT_NEAR(error[5], 0.05, 0.01);
  EXPECT_GT(std::sqrt(result.covariance(0, 0)), 1);
  EXPECT_GT(std::sqrt(result.covariance(1, 1)), 1);
  EXPECT_GT(std::sqrt(result.covariance(5, 5)), 0.1);
  EXPECT_LT(nees(kMotion, result), 22.5);
}

TEST(AcousticRegistration, AnotherSeabed_IsRefused) {
  const SyntheticSeabed here(0.06, 1), elsewhere(0.06, 7);
  FixedRandom random(4);
  const auto result = registered(here.seen(kA, 8, 6000, kNoise_m, random),
                                 elsewhere.seen(kA * kMotion, 6, 4000, kNoise_m, random), kMotion, withoutFloor());
  EXPECT_NE(result.fit, AcousticFit::good);
}

TEST(AcousticRegistration, RegularRipples_AreRefusedOnceTheOdometryLeavesRoomForTheNext) {
  const SyntheticSeabed ripples = SyntheticSeabed::ripples(0.15, 1.6);
  FixedRandom random(5);
  AcousticRegistrationOptions options = withoutFloor();
  options.startSpacing_m = 0.8;
  const AcousticCloud a = ripples.seen(kA, 8, 6000, kNoise_m, random);
  const AcousticCloud b = ripples.seen(kA * kMotion, 5, 4000, kNoise_m, random);
  EXPECT_EQ(registered(a, b, kMotion, options, 0.05).fit, AcousticFit::good);
  EXPECT_EQ(registered(a, b, kMotion, options, 0.8).fit, AcousticFit::ambiguous);
}

TEST(AcousticRegistration, ErrorSharedByTheSwath_IsNotTakenForMotion) {
  const SyntheticSeabed seabed(0.06, 1);
  FixedRandom random(6);
  // Two passes in opposite directions; the swath lies 6 cm too far ahead both times, as one standard deviation says.
  const core::Isometry T_a_b = core::isometryFromXyzYpr(0.5, 0.5, 0, M_PI, 0, 0);
  SharedErrors shared_m = SharedErrors::Zero();
  shared_m(0, 0) = 0.06F;
  double told = 0, untold = 0;
  for (int trial = 0; trial < 5; ++trial) {
    AcousticCloud a = seabed.seen(kA, 8, 6000, kNoise_m, random),
                  b = seabed.seen(kA * T_a_b, 6, 4000, kNoise_m, random);
    for (AcousticCloud* cloud : {&a, &b})
      for (auto& point : *cloud) point.p += shared_m.col(0);
    untold += nees(T_a_b, registered(a, b, T_a_b, withoutFloor())) / 5;
    for (AcousticCloud* cloud : {&a, &b})
      for (auto& point : *cloud) point.shared_m = shared_m;
    const auto result = registered(a, b, T_a_b, withoutFloor());
    told += nees(T_a_b, result) / 5;
    // It was one standard deviation; the way along the seabed is uncertain with it, so the prior holds part of it back.
    EXPECT_GT(result.sharedErrors[0], 0.2);
    EXPECT_LT(result.sharedErrors[0], 1.5);
  }
  EXPECT_LT(told, 6);           // the number of degrees of freedom
  EXPECT_GT(untold, 2 * told);  // or the test would show nothing
}

TEST(AcousticRegistration, TooFewPoints_AreRefused) {
  FixedRandom random(8);
  const SyntheticSeabed seabed(0.06, 1);
  const AcousticCloud a = seabed.seen(kA, 8, 6000, kNoise_m, random);
  EXPECT_EQ(registered(a, {}, kMotion, {}).fit, AcousticFit::tooFewPoints);
  EXPECT_EQ(registered({}, a, kMotion, {}).fit, AcousticFit::tooFewPoints);
}

TEST(AcousticSubmap, Thinned_WeighsByVarianceAndDropsWhatIsNoPoint) {
  const SharedErrors none = SharedErrors::Zero();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const AcousticCloud points{{{0.1F, 0.1F, 0.1F}, 0.01F, none},
                             {{0.4F, 0.1F, 0.1F}, 0.02F, none},
                             {{nan, 0, 0}, 0.01F, none},
                             {{2, 2, 2}, 0, none},
                             {{3.1F, 0.1F, 0.1F}, 0.5F, none}};
  const AcousticCloud result = thinned(points, 1.0, 0.001);
  ASSERT_EQ(result.size(), 2U);
  EXPECT_NEAR(result[0].p.x(), (4 * 0.1 + 0.4) / 5, 1e-6);  // weights 1 / sigma^2, 4 to 1
  EXPECT_NEAR(result[0].sigma_m, 1 / std::sqrt(1e4 + 2500), 1e-6);
  EXPECT_NEAR(result[1].sigma_m, 0.5, 1e-6);
  EXPECT_NEAR(thinned(points, 1.0, 0.1)[0].sigma_m, 0.1, 1e-6);  // the least that is believed
}
