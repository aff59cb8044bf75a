#include "s2s/eval/distribution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "s2s/eval/hydrographic_order.h"

using namespace s2s::eval;

namespace {

std::vector<double> gaussian(const std::vector<double>& at, double mean, double sigma) {
  std::vector<double> density;
  for (const double x : at)
    density.push_back(std::exp(-0.5 * std::pow((x - mean) / sigma, 2)) / (sigma * std::sqrt(2 * M_PI)));
  return density;
}

/// Of two normal distributions: H² = 1 - sqrt(2 s1 s2 / (s1² + s2²)) exp(-(m1 - m2)² / (4 (s1² + s2²))).
double hellingerOfGaussians(double m1, double s1, double m2, double s2) {
  const double v = s1 * s1 + s2 * s2;
  return std::sqrt(1 - std::sqrt(2 * s1 * s2 / v) * std::exp(-(m1 - m2) * (m1 - m2) / (4 * v)));
}

}  // namespace

TEST(Hellinger, TwoGaussians_EqualTheClosedForm) {
  const auto at = binCentres(-30, 30, 6000);
  for (const auto& [m2, s2] : std::vector<std::pair<double, double>>{{0.5, 1}, {0, 2}, {1.5, 0.7}, {4, 0.5}})
    // The midpoint sum of a smooth density that vanishes at the limits is exact to far better than this.
    EXPECT_NEAR(hellingerDistance(gaussian(at, 0, 1), gaussian(at, m2, s2)), hellingerOfGaussians(0, 1, m2, s2), 1e-8);
}

TEST(Hellinger, SameAndDisjoint_AreZeroAndOne) {
  EXPECT_NEAR(hellingerDistance({1, 2, 3}, {2, 4, 6}), 0, 1e-7);  // the root of a rounding error of 1e-16
  EXPECT_NEAR(hellingerDistance({1, 0, 0}, {0, 3, 1}), 1, 1e-15);
}

TEST(GaussianKde, SinglePoint_IsTheKernel) {
  const auto at = binCentres(-3, 3, 50);
  const auto kernel = gaussian(at, 0.4, 0.3);
  const auto density = gaussianKde({0.4}, 0.3, at);
  for (std::size_t i = 0; i < at.size(); ++i) EXPECT_NEAR(density[i], kernel[i], 1e-14);
}

TEST(GaussianKde, AnyPoints_IntegrateToOne) {
  const auto at = binCentres(-20, 20, 4000);
  double sum = 0;
  for (const double d : gaussianKde({-3, 0, 0.1, 4.5}, 0.5, at)) sum += d * 0.01;
  EXPECT_NEAR(sum, 1, 1e-10);  // the limits are 31 bandwidths away
}

TEST(ScottBandwidth, KnownSample_EqualsTheFormula) {
  // 32 values, half at -1 and half at 1: s² = 32/31 and n^(-1/5) = 1/2.
  std::vector<double> values(32, 1.0);
  for (int i = 0; i < 16; ++i) values[static_cast<std::size_t>(i)] = -1;
  EXPECT_NEAR(scottBandwidth(values), 0.5 * std::sqrt(32.0 / 31.0), 1e-14);
}

TEST(BinCentres, ThreeBins_LieInTheirMiddles) {
  const auto centres = binCentres(0, 3, 3);
  ASSERT_EQ(centres.size(), 3u);
  EXPECT_DOUBLE_EQ(centres[0], 0.5);
  EXPECT_DOUBLE_EQ(centres[2], 2.5);
}

TEST(HydrographicOrder, TenMetres_GivesTheStandardsFigures) {
  // sqrt(0.15² + 0.075²), sqrt(0.25² + 0.075²), sqrt(0.5² + 0.13²), worked by hand to 1e-4 m.
  EXPECT_NEAR(totalVerticalUncertainty_m(kHydrographicOrders[0], 10), 0.1677, 5e-5);
  EXPECT_NEAR(totalVerticalUncertainty_m(kHydrographicOrders[1], 10), 0.2610, 5e-5);
  EXPECT_NEAR(totalVerticalUncertainty_m(kHydrographicOrders[2], 10), 0.5166, 5e-5);
}

TEST(HydrographicOrder, AboveTheWater_CountsAsDepthZero) {
  EXPECT_DOUBLE_EQ(totalVerticalUncertainty_m(kHydrographicOrders[0], -3), 0.15);
}
