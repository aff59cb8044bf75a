#include <gtest/gtest.h>

#include "s2s/sim/random.h"
#include "s2s/sim/sonar_receiver.h"
#include "sim_support.h"

using namespace s2s;
using namespace s2s::test;

namespace {

double normalCdf(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

}  // namespace

TEST(Random, SameKey_SameNumbers_OtherKey_Others) {
  sim::Random a(1, 2, 3), b(1, 2, 3), c(1, 2, 4), d(1, 3, 3), e(2, 2, 3);
  const auto first = a.bits();
  EXPECT_EQ(first, b.bits());
  EXPECT_NE(first, c.bits());
  EXPECT_NE(first, d.bits());
  EXPECT_NE(first, e.bits());
}

TEST(Random, Distributions_PassKolmogorovSmirnov) {
  constexpr std::size_t kCount = 20000;
  sim::Random random(11);
  std::vector<double> uniform, normal, exponential;
  for (std::size_t i = 0; i < kCount; ++i) {
    uniform.push_back(random.uniform());
    normal.push_back(random.normal());
    exponential.push_back(random.exponential());
  }
  const double limit = kolmogorovLimit(kCount);
  EXPECT_LT(kolmogorovDistance(uniform, [](double x) { return x; }), limit);
  EXPECT_LT(kolmogorovDistance(normal, normalCdf), limit);
  EXPECT_LT(kolmogorovDistance(exponential, [](double x) { return 1 - std::exp(-x); }), limit);
}

TEST(Random, FirstNumbersOfNeighbouringRecords_AreIndependent) {
  // Correlation of n pairs has a standard deviation of 1/sqrt(n); four of them.
  constexpr int kCount = 10000;
  double sum = 0;
  for (int i = 0; i < kCount; ++i)
    sum += (sim::Random(1, 1, i).uniform() - 0.5) * (sim::Random(1, 1, i + 1).uniform() - 0.5) * 12;
  EXPECT_LT(std::abs(sum / kCount), 4 / std::sqrt(kCount));
}

TEST(ComplexNormals, BothParts_PassKolmogorovSmirnov_AndAreUncorrelated) {
  constexpr std::size_t kCount = 50000;
  std::vector<float> re(kCount), im(kCount);
  sim::fillComplexNormals(0x123456789abcdefULL, kCount, re.data(), im.data());
  EXPECT_LT(kolmogorovDistance({re.begin(), re.end()}, normalCdf), kolmogorovLimit(kCount));
  EXPECT_LT(kolmogorovDistance({im.begin(), im.end()}, normalCdf), kolmogorovLimit(kCount));
  double cross = 0, neighbours = 0, powers = 0;
  for (std::size_t i = 0; i + 1 < kCount; ++i) {
    cross += re[i] * im[i];
    neighbours += re[i] * re[i + 1];
    powers += (re[i] * re[i] - 1.0) * (im[i] * im[i] - 1.0);
  }
  // Four standard deviations of a mean of products of standard normals (the last product's deviation is 2).
  EXPECT_LT(std::abs(cross) / kCount, 4 / std::sqrt(kCount));
  EXPECT_LT(std::abs(neighbours) / kCount, 4 / std::sqrt(kCount));
  EXPECT_LT(std::abs(powers) / kCount, 8 / std::sqrt(kCount));
}

TEST(ComplexNormals, OtherKey_OtherField) {
  std::vector<float> a(64), b(64), im(64);
  sim::fillComplexNormals(1, 64, a.data(), im.data());
  sim::fillComplexNormals(2, 64, b.data(), im.data());
  EXPECT_NE(a, b);
}
