#include <gtest/gtest.h>

#include "fixed_random.h"
#include "s2s/graph/odometry_chain.h"

using namespace s2s;
using namespace s2s::graph;
using graph::test::diagonalCovariance;
using graph::test::difference;
using graph::test::FixedRandom;
using graph::test::perturbed;

namespace {

std::vector<core::Isometry> circle(int steps) {
  std::vector<core::Isometry> poses;
  for (int n = 0; n < steps; ++n)
    poses.push_back(core::isometryFromXyzYpr(30 * std::sin(0.1 * n), 30 - 30 * std::cos(0.1 * n), 0.02 * n, 0.1 * n,
                                             0.05 * std::sin(n), 0));
  return poses;
}

}  // namespace

TEST(Adjoint, MovesAPerturbationToTheOtherSide) {
  FixedRandom random(41);
  const core::Isometry T = random.pose(5, 1);
  const core::Vector6 d = random.normal6(1e-6, 1e-6);
  const core::Vector6 moved = adjoint(T) * d;
  const core::Isometry left = perturbed(core::Isometry::Identity(), moved) * T;
  EXPECT_LT((left.matrix() - perturbed(T, d).matrix()).norm(), 1e-10);  // second order of 1e-6 at 5 m
}

TEST(OdometryChain, Covariance_IsThatOfSimulatedDrift) {
  const auto truth = circle(40);
  const core::Matrix6 step = diagonalCovariance(0.01, 0.002);
  OdometryChain chain;
  for (const auto& T : truth) chain.append(T, step);

  FixedRandom random(42);
  core::Matrix6 sampled = core::Matrix6::Zero();
  const int kSamples = 4000, kFrom = 5, kTo = 35;
  for (int sample = 0; sample < kSamples; ++sample) {
    core::Isometry T = core::Isometry::Identity();
    for (int n = kFrom + 1; n <= kTo; ++n)
      T = T * perturbed(truth[n - 1].inverse() * truth[n], random.normal6(0.01, 0.002));
    const core::Vector6 d = difference(truth[kFrom].inverse() * truth[kTo], T);
    sampled += d * d.transpose() / kSamples;
  }
  const core::Matrix6 predicted = chain.covariance(kFrom, kTo);
  // A sample variance of 4000 draws has a relative deviation of 2.2 %; five of these.
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(sampled(i, i) / predicted(i, i), 1, 0.11) << i;
}

TEST(OdometryChain, ReversedPair_HasTheCovarianceOfTheInverse) {
  OdometryChain chain;
  for (const auto& T : circle(20)) chain.append(T, diagonalCovariance(0.01, 0.002));
  const core::Matrix6 Ad = adjoint(chain.relative(3, 15));
  EXPECT_TRUE(chain.covariance(15, 3).isApprox(Ad * chain.covariance(3, 15) * Ad.transpose(), 1e-9));
}

TEST(OdometryChain, Travelled_IsTheLengthOfThePath) {
  OdometryChain chain;
  for (int n = 0; n < 5; ++n)
    chain.append(core::isometryFromXyzYpr(2.0 * (n % 2), 0, 0, 0, 0, 0), core::Matrix6::Zero());
  EXPECT_DOUBLE_EQ(chain.travelled_m(0, 4), 8);
  EXPECT_DOUBLE_EQ(chain.travelled_m(4, 1), 6);
}

TEST(OdometryChain, FarFromTheOrigin_KeepsItsDigits) {
  OdometryChain near, far;
  core::Isometry offset = core::Isometry::Identity();
  offset.translation() << 3000, -2000, 10;
  for (const auto& T : circle(20)) {
    near.append(T, diagonalCovariance(0.01, 0.0005));
    far.append(offset * T, diagonalCovariance(0.01, 0.0005));
  }
  // Sums of squares of 3600 m times 5e-4 rad lose about 7 of 16 digits.
  EXPECT_TRUE(far.covariance(2, 18).isApprox(near.covariance(2, 18), 1e-6));
}
