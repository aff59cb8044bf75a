#include "s2s/eval/wall_similarity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "s2s/core/error.h"

using namespace s2s;
using namespace s2s::eval;

namespace {

using Points = std::vector<Eigen::Vector3d>;

/// A wall of 40 m whose line passes through (50, -20) at 30°, in the map; water at 1.5 m.
const core::Isometry T_map_wall = core::isometryFromXyzYpr(50, -20, 1.5, M_PI / 6, 0, 0);

WallOptions wallOptions() {
  WallOptions options;
  options.from_m = (T_map_wall * Eigen::Vector3d(-20, 0, 0)).head<2>();
  options.to_m = (T_map_wall * Eigen::Vector3d(20, 0, 0)).head<2>();
  options.halfWidth_m = 1.5;
  options.waterHeight_m = 1.5;
  return options;
}

/// A regular slab of points in the wall's frame: x in ±20 m, y uniform in centre ± width / 2, z in [zMin, zMax].
Points slab(double centre_m, double width_m, double zMin, double zMax, int alongCount = 400, int acrossCount = 101) {
  Points points;
  for (int i = 0; i < alongCount; ++i)
    for (int k = 0; k < acrossCount; ++k) {
      const double x = -20 + 40 * (i + 0.5) / alongCount;
      const double y = centre_m + width_m * (static_cast<double>(k) / (acrossCount - 1) - 0.5);
      points.push_back(T_map_wall * Eigen::Vector3d(x, y, zMin + (zMax - zMin) * ((7 * i + k) % 10) / 9.0));
    }
  return points;
}

}  // namespace

TEST(WallSimilarity, UniformSlabs_LoseATenthOfTheirWidthByTrimming) {
  // Of 101 equally spaced values 5 % at each end are cut: from -0.5 … 0.5 to -0.45 … 0.45 of the width, up to one
  // spacing of 1 %.
  const WallReport report = compareWall(slab(0, 0.8, 0.1, 3), slab(0, 0.5, -3, -0.1), wallOptions());
  EXPECT_NEAR(report.lidar.width_m, 0.9 * 0.8, 0.011 * 0.8);
  EXPECT_NEAR(report.sonar.width_m, 0.9 * 0.5, 0.011 * 0.5);
  EXPECT_NEAR(report.widthDifference_m, -0.27, 0.011);
  EXPECT_NEAR(report.length_m, 40, 1e-9);
  EXPECT_NEAR(report.offset_m, 0, 1e-9);
}

TEST(WallSimilarity, SameDistributions_AreAtDistanceZero) {
  const WallReport report = compareWall(slab(0, 0.5, 0.1, 3), slab(0, 0.5, -3, -0.1), wallOptions());
  EXPECT_NEAR(report.hellinger, 0, 1e-6);
  EXPECT_NEAR(report.cosineSimilarity, 1, 1e-12);  // each sonar point has a LiDAR point straight above
}

TEST(WallSimilarity, NormalDistributions_GiveTheClosedFormOfTheSmoothedOnes) {
  // Points with normal y: the kernel estimate of the untrimmed points is a normal distribution of variance s² + h².
  WallOptions options = wallOptions();
  options.trimShare = 0;
  options.refine = false;
  std::mt19937 random(11);
  const auto cloud = [&](double mean, double sigma, double z) {
    std::normal_distribution<double> across(mean, sigma);
    std::uniform_real_distribution<double> along(-20, 20);
    Points points;
    for (int i = 0; i < 40000; ++i) points.push_back(T_map_wall * Eigen::Vector3d(along(random), across(random), z));
    return points;
  };
  const WallReport report = compareWall(cloud(0, 0.10, 1), cloud(0.15, 0.20, -1), options);
  const double s1 = std::hypot(0.10, report.lidar.bandwidth_m), s2 = std::hypot(0.20, report.sonar.bandwidth_m);
  const double v = s1 * s1 + s2 * s2;
  const double closed = std::sqrt(1 - std::sqrt(2 * s1 * s2 / v) * std::exp(-0.15 * 0.15 / (4 * v)));
  // 40000 samples: the mean is known to 0.001 m of a shift of 0.15 m, the density at a place to about 1 %.
  EXPECT_NEAR(report.hellinger, closed, 0.01);
  EXPECT_NEAR(report.offset_m, 0.15, 0.004);
}

TEST(WallSimilarity, LidarBelowTheWater_IsDisregarded) {
  Points lidar = slab(0, 0.5, 0.1, 3);
  const WallReport before = compareWall(lidar, slab(0, 0.5, -3, -0.1), wallOptions());
  const Points reflections = slab(0.4, 1.8, -3, -0.05);
  lidar.insert(lidar.end(), reflections.begin(), reflections.end());
  const WallReport after = compareWall(lidar, slab(0, 0.5, -3, -0.1), wallOptions());
  EXPECT_EQ(before.lidar.points, after.lidar.points);
  EXPECT_DOUBLE_EQ(before.lidar.width_m, after.lidar.width_m);
}

TEST(WallSimilarity, LineGivenAskew_IsTurnedOntoTheLidarWall) {
  WallOptions options = wallOptions();
  options.from_m = (T_map_wall * Eigen::Vector3d(-20, -0.4, 0)).head<2>();
  options.to_m = (T_map_wall * Eigen::Vector3d(20, 0.6, 0)).head<2>();
  const WallReport report = compareWall(slab(0, 0.4, 0.1, 3), slab(0.1, 0.4, -3, -0.1), options);
  // The line runs 1 m over 40 m off, and is to be found to well under the spacing of the points (4 mm across).
  EXPECT_NEAR(report.turn_rad, -std::atan2(1, 40), 1e-3);
  EXPECT_NEAR(report.shift_m, -0.1, 0.01);
  EXPECT_NEAR(report.lidar.width_m, 0.36, 0.02);
  EXPECT_NEAR(report.offset_m, 0.1, 0.002);
  options.refine = false;
  EXPECT_GT(compareWall(slab(0, 0.4, 0.1, 3), slab(0.1, 0.4, -3, -0.1), options).lidar.width_m, 0.9);
}

TEST(WallSimilarity, SonarLimit_LeavesTheSeabedOut) {
  Points sonar = slab(0, 0.3, -3, -0.1);
  const Points seabed = slab(0.5, 1.8, -4, -3.9);
  sonar.insert(sonar.end(), seabed.begin(), seabed.end());
  WallOptions options = wallOptions();
  options.sonarMinHeight_m = 1.5 - 3.5;
  EXPECT_NEAR(compareWall(slab(0, 0.3, 0.1, 3), sonar, options).sonar.width_m, 0.27, 0.01);
}

TEST(WallSimilarity, CosineIn3d_SeesTheHeightDifference) {
  WallOptions options = wallOptions();
  options.cosineIn3d = true;
  const WallReport report = compareWall(slab(0, 0.3, 1, 1), slab(0, 0.3, -1, -1), options);
  // Along the line y = 0 the mean of (x² - 1) / (x² + 1) over |x| <= 20 is 1 - atan(20) / 10; the slab's width of
  // ±0.15 m changes it near the middle only.
  EXPECT_NEAR(report.cosineSimilarity, 1 - std::atan(20) / 10, 0.005);
}

TEST(WallSimilarity, NothingOnTheWall_IsRefused) {
  EXPECT_THROW(compareWall({}, slab(0, 0.3, -3, -0.1), wallOptions()), core::InputError);
  EXPECT_THROW(compareWall(slab(0, 0.3, 0.1, 3), {}, wallOptions()), core::InputError);
  WallOptions options = wallOptions();
  options.to_m = options.from_m;
  EXPECT_THROW(compareWall(slab(0, 0.3, 0.1, 3), slab(0, 0.3, -3, -1), options), core::InputError);
}
