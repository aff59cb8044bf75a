#include "s2s/eval/statistics.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace s2s::eval;

TEST(Statistics, FiveKnownValues_GiveTheirClosedForms) {
  const Summary s = summarise({5, 1, 4, 2, 3});
  EXPECT_EQ(s.count, 5u);
  // Sums of a few integers are exact up to the rounding of one division or root.
  EXPECT_NEAR(s.mean, 3, 1e-15);
  EXPECT_NEAR(s.median, 3, 1e-15);
  EXPECT_NEAR(s.rmse, std::sqrt(11.0), 1e-15);
  EXPECT_NEAR(s.std, std::sqrt(2.0), 1e-15);
  EXPECT_EQ(s.min, 1);
  EXPECT_EQ(s.max, 5);
  EXPECT_NEAR(s.p95, 4.8, 1e-14);  // position 0.95 * 4 = 3.8, between 4 and 5
}

TEST(Statistics, NoValues_GiveZerosAndNoPercentile) {
  EXPECT_EQ(summarise({}).count, 0u);
  EXPECT_EQ(summarise({}).rmse, 0);
  EXPECT_TRUE(std::isnan(percentile({}, 0.5)));
  EXPECT_EQ(shareWithin({}, 1), 0);
}

TEST(Statistics, ShareWithin_CountsMagnitudesUpToTheLimit) {
  EXPECT_DOUBLE_EQ(shareWithin({-0.05, 0.1, 0.11, -0.3}, 0.1), 0.5);
}

TEST(StudentT, OneAndTwoDegreesOfFreedom_EqualTheirClosedForms) {
  for (const double t : {-30.0, -2.0, -0.3, 0.0, 0.7, 1.5, 12.0}) {
    // Cauchy, and F(t) = 1/2 + t / (2 sqrt(2 + t²)); the continued fraction converges to a few units of the last place.
    EXPECT_NEAR(studentTCdf(t, 1), 0.5 + std::atan(t) / M_PI, 1e-13) << t;
    EXPECT_NEAR(studentTCdf(t, 2), 0.5 + t / (2 * std::sqrt(2 + t * t)), 1e-13) << t;
  }
}

TEST(StudentT, TabulatedQuantiles_AreReached) {
  // Two-sided 95 % column of the usual table (e.g. Abramowitz & Stegun table 26.10), given to three decimals.
  const std::vector<std::pair<double, double>> table = {{1, 12.706}, {2, 4.303}, {3, 3.182},  {4, 2.776},
                                                        {5, 2.571},  {9, 2.262}, {30, 2.042}, {120, 1.980}};
  for (const auto& [dof, t] : table) EXPECT_NEAR(studentTQuantile(0.975, dof), t, 5.1e-4) << dof;
  EXPECT_NEAR(studentTQuantile(0.025, 4), -2.776, 5.1e-4);
}

TEST(MeanInterval, FiveValues_UseFourDegreesOfFreedom) {
  // s = sqrt(2.5), t = 2.776 (table, three decimals): half width 2.776 * sqrt(2.5 / 5).
  const MeanInterval interval = meanInterval95({1, 2, 3, 4, 5});
  EXPECT_NEAR(interval.mean, 3, 1e-15);
  EXPECT_NEAR(interval.halfWidth, 2.776 * std::sqrt(0.5), 5e-4);
}

TEST(MeanInterval, OneValue_HasNoInterval) {
  EXPECT_EQ(meanInterval95({2}).mean, 2);
  EXPECT_TRUE(std::isnan(meanInterval95({2}).halfWidth));
}
