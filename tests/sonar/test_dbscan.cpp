#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "s2s/core/error.h"
#include "s2s/sonar/dbscan.h"

namespace s2s::sonar {
namespace {

using Points = std::vector<Eigen::Vector2d>;

/// The definition, in O(n^2): cores, their connected components, border points by their nearest core.
std::vector<int> bruteForce(const Points& points, const DbscanOptions& options) {
  const std::size_t n = points.size();
  const double limit = options.epsilon_m * options.epsilon_m;
  const auto squared = [&](std::size_t a, std::size_t b) { return (points[a] - points[b]).squaredNorm(); };
  std::vector<char> core(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    int count = 0;
    for (std::size_t j = 0; j < n; ++j) count += squared(i, j) <= limit ? 1 : 0;
    core[i] = count >= options.minPoints ? 1 : 0;
  }
  std::vector<int> labels(n, kNoise);
  int clusters = 0;
  for (std::size_t seed = 0; seed < n; ++seed) {
    if (core[seed] == 0 || labels[seed] != kNoise) continue;
    std::vector<std::size_t> stack{seed};
    labels[seed] = clusters;
    while (!stack.empty()) {
      const std::size_t i = stack.back();
      stack.pop_back();
      for (std::size_t j = 0; j < n; ++j)
        if (core[j] != 0 && labels[j] == kNoise && squared(i, j) <= limit) {
          labels[j] = clusters;
          stack.push_back(j);
        }
    }
    ++clusters;
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (core[i] != 0) continue;
    double best = limit;
    for (std::size_t j = n; j-- > 0;)
      if (core[j] != 0 && squared(i, j) <= best) {
        best = squared(i, j);
        labels[i] = labels[j];
      }
  }
  return labels;
}

/// A mix of blobs, lines and clutter; every third set lies on a lattice, where distances tie and equal epsilon.
Points randomSet(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> anywhere(-2, 2), spread(0.02, 0.4);
  std::normal_distribution<double> normal;
  std::uniform_int_distribution<int> blobs(1, 6), size(5, 120);
  Points points;
  for (int b = blobs(random); b > 0; --b) {
    const Eigen::Vector2d center(anywhere(random), anywhere(random));
    const double sx = spread(random), sy = spread(random);
    for (int i = size(random); i > 0; --i)
      points.emplace_back(center.x() + sx * normal(random), center.y() + sy * normal(random));
  }
  for (int i = size(random); i > 0; --i) points.emplace_back(anywhere(random), anywhere(random));
  if (seed % 3 == 0)
    for (auto& p : points) p = (p / 0.0625).array().round() * 0.0625;  // exact in binary
  std::shuffle(points.begin(), points.end(), random);
  return points;
}

TEST(Dbscan, RandomSets_EqualBruteForce) {
  int clustersSeen = 0, noiseSeen = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const Points points = randomSet(seed);
    DbscanOptions options;
    options.epsilon_m = seed % 3 == 0 ? 0.25 : 0.2;
    options.minPoints = 3 + static_cast<int>(seed % 18);
    const auto labels = dbscan(points, options);
    ASSERT_EQ(labels, bruteForce(points, options)) << "set " << seed;
    clustersSeen += *std::max_element(labels.begin(), labels.end()) + 1;
    noiseSeen += static_cast<int>(std::count(labels.begin(), labels.end(), kNoise));
  }
  EXPECT_GT(clustersSeen, 200);  // the sets are not trivial
  EXPECT_GT(noiseSeen, 1000);
}

TEST(Dbscan, OrderOfPoints_DoesNotChangeTheClusters) {
  const Points points = randomSet(11);
  DbscanOptions options;
  options.minPoints = 8;
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), std::mt19937(5));
  Points shuffled;
  for (const std::size_t i : order) shuffled.push_back(points[i]);
  const auto a = dbscan(points, options), b = dbscan(shuffled, options);
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_EQ(a[order[i]] == a[order[j]], b[i] == b[j]) << order[i] << " " << order[j];
}

TEST(Dbscan, BorderPointBetweenTwoClusters_TakesTheNearerCore) {
  Points points;
  for (int i = 0; i < 5; ++i) points.emplace_back(0, 0.001 * i);
  for (int i = 0; i < 5; ++i) points.emplace_back(0.36, 0.001 * i);
  points.emplace_back(0.17, 0);  // 0.17 from the left cores, 0.19 from the right ones
  DbscanOptions options;
  options.minPoints = 7;  // with itself 11 points in reach of the middle one, but only 6 of each end
  const auto far = dbscan(points, options);
  EXPECT_EQ(far.back(), far.front());  // the middle point is a core here and joins both
  options.minPoints = 5;
  points.back().x() = 0.18;
  Points tied = points;
  tied.erase(tied.begin() + 9);  // four on the right: with the middle point a core again
  EXPECT_EQ(dbscan(tied, options), bruteForce(tied, options));
}

TEST(Dbscan, NoPoints_GivesNoLabels) { EXPECT_TRUE(dbscan({}, {}).empty()); }

TEST(Dbscan, FewerThanMinPoints_IsAllNoise) {
  EXPECT_EQ(dbscan(Points(19, Eigen::Vector2d(1, 1)), {}), std::vector<int>(19, kNoise));
  EXPECT_EQ(dbscan(Points(20, Eigen::Vector2d(1, 1)), {}), std::vector<int>(20, 0));
}

TEST(Dbscan, WrongOptions_AreRefused) {
  EXPECT_THROW(dbscan({}, {0, 20}), core::ConfigError);
  EXPECT_THROW(dbscan({}, {0.2, 0}), core::ConfigError);
}

}  // namespace
}  // namespace s2s::sonar
