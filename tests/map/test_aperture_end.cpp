#include "s2s/map/aperture_end.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace {

using s2s::map::ApertureEnd;

constexpr double kDegree = M_PI / 180;
constexpr double kPrior_rad = 2 * kDegree;

std::vector<double> ping(double middle_rad, std::size_t returns = 21) {
  return std::vector<double>(returns, middle_rad);
}

TEST(ApertureEnd, NothingSeen_IsTheNominalEndWithThePriorsSigma) {
  const ApertureEnd end(kPrior_rad);
  EXPECT_EQ(end.beyond_rad(), 0);
  EXPECT_EQ(end.sigma_rad(), kPrior_rad);
}

TEST(ApertureEnd, OnePing_IsDrawnTowardsTheNominalEnd) {
  ApertureEnd end(kPrior_rad);
  end.addPing(ping(1 * kDegree));
  EXPECT_GT(end.beyond_rad(), 0);
  EXPECT_LT(end.beyond_rad(), 0.6 * kDegree);
  EXPECT_LT(end.sigma_rad(), kPrior_rad);
}

TEST(ApertureEnd, SomethingElseExpected_IsDrawnTowardsThat) {
  ApertureEnd end(kPrior_rad);
  EXPECT_EQ(end.beyond_rad(0.3 * kDegree), 0.3 * kDegree);
  end.addPing(ping(1 * kDegree));
  EXPECT_GT(end.beyond_rad(0.3 * kDegree), end.beyond_rad());
  EXPECT_LT(end.beyond_rad(0.3 * kDegree), 1 * kDegree);
}

TEST(ApertureEnd, ManyPings_ErrorKeepsToTheSigma) {
  std::mt19937 random(5);
  std::normal_distribution<double> end_rad(0, 1 * kDegree), noise_rad(0, 0.7 * kDegree);
  double sum = 0;
  constexpr int kSurveys = 200, kPings = 300;
  for (int survey = 0; survey < kSurveys; ++survey) {
    const double truth = end_rad(random);
    ApertureEnd end(kPrior_rad);
    // Ten neighbouring pings meet the same piece of bed: they are wrong alike.
    double common = 0;
    for (int i = 0; i < kPings; ++i) {
      if (i % 10 == 0) common = noise_rad(random);
      end.addPing(ping(truth + common));
    }
    EXPECT_LT(std::abs(end.beyond_rad() - truth), 5 * end.sigma_rad());
    sum += std::pow((end.beyond_rad() - truth) / end.sigma_rad(), 2);
  }
  // Mean square of 200 normal values: 1 within 0.1; the median of thirty values has its asymptotic sigma within a
  // tenth.
  EXPECT_NEAR(sum / kSurveys, 1, 0.4);
}

TEST(ApertureEnd, AThirdOfPingsMetAnotherThing_MedianHardlyMoves) {
  std::mt19937 random(6);
  std::normal_distribution<double> noise_rad(0, 0.3 * kDegree);
  ApertureEnd end(kPrior_rad);
  for (int i = 0; i < 600; ++i) end.addPing(ping((i % 3 == 0 ? 3 : 0.5) * kDegree + noise_rad(random)));
  // The median moves to the 75th percentile of the others: 0.67 of their scatter.
  EXPECT_NEAR(end.beyond_rad(), 0.5 * kDegree + 0.67 * 0.3 * kDegree, 0.1 * kDegree);
}

TEST(ApertureEnd, FewReturnsFarOffOrNotFinite_DoNotCount) {
  ApertureEnd end(kPrior_rad);
  end.addPing({});
  end.addPing(ping(1 * kDegree, 4));
  end.addPing(ping(2 * ApertureEnd::kReach_rad));
  end.addPing(ping(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_EQ(end.pings(), 0u);
  EXPECT_EQ(end.beyond_rad(), 0);
}

TEST(ApertureEnd, NominalEndBelievedWithoutDoubt_Stays) {
  ApertureEnd end(0);
  for (int i = 0; i < 50; ++i) end.addPing(ping(1 * kDegree));
  EXPECT_EQ(end.beyond_rad(), 0);
  EXPECT_EQ(end.sigma_rad(), 0);
}

}  // namespace
