#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "s2s/sonar/leading_edge.h"
#include "synthetic_pings.h"

namespace s2s::sonar {
namespace {

PingGeometry smallGeometry() { return geometryOf(test::emptyPing(50, 200)); }

TEST(LeadingEdge, RandomImage_IsTheNearestBinAboveTheThreshold) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> grey(0, 90);
  cv::Mat image(200, 50, CV_8U);
  for (int r = 0; r < image.rows; ++r)
    for (int c = 0; c < image.cols; ++c) image.at<std::uint8_t>(r, c) = static_cast<std::uint8_t>(grey(random));
  image.col(7).setTo(80);  // not above 80
  const auto geometry = smallGeometry();
  const LeadingEdgeOptions options;
  const auto scan = findLeadingEdge(image, geometry, options);
  std::vector<int> found(50, -1);
  for (const auto& r : scan.returns) found[r.beam] = static_cast<int>(r.bin);
  for (int beam = 0; beam < 50; ++beam) {
    int expected = -1;
    for (int bin = 199; bin >= 0; --bin)
      if (geometry.range_m(bin) >= options.minRange_m && image.at<std::uint8_t>(bin, beam) > 80) expected = bin;
    EXPECT_EQ(found[static_cast<std::size_t>(beam)], expected) << beam;
  }
  EXPECT_EQ(found[7], -1);
}

TEST(LeadingEdge, Return_KnowsItsPlaceAndStrength) {
  cv::Mat image(200, 50, CV_8U, cv::Scalar(0));
  image.at<std::uint8_t>(100, 10) = 200;
  const auto geometry = smallGeometry();
  const auto scan = findLeadingEdge(image, geometry, {});
  ASSERT_EQ(scan.returns.size(), 1u);
  const auto& r = scan.returns[0];
  EXPECT_NEAR(r.range_m, 100.5 * 0.05, 1e-12);
  EXPECT_NEAR(r.bearing_rad, geometry.bearings_rad[10], 1e-12);
  EXPECT_EQ(r.intensity, 200);
  EXPECT_NEAR(r.rangeSigma_m, std::hypot(0.01, 0.05 / std::sqrt(12.0)), 1e-12);
  const Eigen::Vector3d p = scan.planePoint(r);
  EXPECT_NEAR(p.x(), r.range_m * std::cos(r.bearing_rad), 1e-12);
  EXPECT_NEAR(p.y(), r.range_m * std::sin(r.bearing_rad), 1e-12);
  EXPECT_EQ(p.z(), 0);
}

TEST(LeadingEdge, Arc_KeepsWhatTheSonarMeasured) {
  for (const auto model : {obs::BearingModel::Azimuth, obs::BearingModel::Cone}) {
    LineScan scan;
    scan.bearingModel = model;
    scan.verticalAperture_rad = 20 * test::kDeg;
    LineReturn r;
    r.range_m = 5;
    r.bearing_rad = 40 * test::kDeg;
    const auto arc = scan.arc(r, 9);
    ASSERT_EQ(arc.size(), 9u);
    for (std::size_t i = 0; i < arc.size(); ++i) {
      const auto c = sonarCoordinates(arc[i], model);
      EXPECT_NEAR(c.range_m, 5, 1e-12);
      EXPECT_NEAR(c.bearing_rad, 40 * test::kDeg, 1e-12);
      EXPECT_NEAR(c.elevation_rad, (-10 + 2.5 * static_cast<double>(i)) * test::kDeg, 1e-12);
    }
  }
}

TEST(LeadingEdge, SeveralReturns_FindsTheSurfaceBehindTheFirst) {
  cv::Mat image(200, 50, CV_8U, cv::Scalar(0));
  const auto paint = [&](int from, int to) { image.col(20).rowRange(from, to).setTo(150); };
  paint(60, 70);
  paint(72, 75);  // 0.1 m behind: still the first surface
  paint(110, 120);
  LeadingEdgeOptions options;
  options.maxReturns = 3;
  const auto scan = findLeadingEdge(image, smallGeometry(), options);
  ASSERT_EQ(scan.returns.size(), 2u);
  EXPECT_EQ(scan.returns[0].bin, 60u);
  EXPECT_EQ(scan.returns[1].bin, 110u);
  EXPECT_EQ(scan.returns[1].order, 1);
}

/// A level bed of Rayleigh speckle behind a silent water column, its first bin depending on the bearing.
cv::Mat speckledBed(const PingGeometry& geometry, double meanEcho, double nearest_m, unsigned seed) {
  std::mt19937 random(seed);
  std::exponential_distribution<double> power(1.0);
  cv::Mat image(static_cast<int>(geometry.rangeCount), static_cast<int>(geometry.beamCount()), CV_8U, cv::Scalar(0));
  for (int beam = 0; beam < image.cols; ++beam) {
    const double edge_m = nearest_m / std::cos(geometry.bearings_rad[static_cast<std::size_t>(beam)]);
    for (int bin = 0; bin < image.rows; ++bin)
      if (geometry.range_m(bin) >= edge_m && geometry.range_m(bin) < edge_m + 2)
        image.at<std::uint8_t>(bin, beam) =
            cv::saturate_cast<std::uint8_t>(meanEcho * std::sqrt(power(random) / 0.785));  // mean of the amplitude
  }
  return image;
}

PingGeometry fineGeometry() {
  auto geometry = geometryOf(test::emptyPing(256, 600));
  geometry.rangeResolution_m = 0.0125;
  return geometry;
}

TEST(LeadingEdge, SpeckleDelay_IsTakenOut) {
  const auto geometry = fineGeometry();
  // A dim bed: half of its cells do not exceed the threshold of 80.
  const cv::Mat image = speckledBed(geometry, 80, 3.0, 4);
  LeadingEdgeOptions options;
  const auto errors = [&](const LineScan& scan) {
    double sum = 0, squares = 0;
    for (const auto& r : scan.returns) {
      const double error = r.range_m - 3.0 / std::cos(r.bearing_rad);
      sum += error;
      squares += error * error;
    }
    const auto n = static_cast<double>(scan.returns.size());
    return std::pair(sum / n, std::sqrt(squares / n));
  };
  const auto [lateBy_m, spread_m] = errors(findLeadingEdge(image, geometry, options));
  options.speckleWindow_rad = 3 * test::kDeg;
  const auto scan = findLeadingEdge(image, geometry, options);
  const auto [left_m, leftSpread_m] = errors(scan);
  EXPECT_GT(lateBy_m, 0.012);  // or the test would show nothing
  // The bins are coarser than the model of a continuous delay: half a bin may remain.
  EXPECT_LT(std::abs(left_m), 0.5 * geometry.rangeResolution_m);
  EXPECT_LT(leftSpread_m, 0.8 * spread_m);
  // What the ranges claim: about two thirds of them within one standard deviation, nearly all within three.
  int within1 = 0, within3 = 0;
  for (const auto& r : scan.returns) {
    const double error = std::abs(r.range_m - 3.0 / std::cos(r.bearing_rad));
    within1 += error <= r.rangeSigma_m ? 1 : 0;
    within3 += error <= 3 * r.rangeSigma_m ? 1 : 0;
  }
  EXPECT_GT(within1, 0.6 * static_cast<double>(scan.returns.size()));
  EXPECT_GT(within3, 0.97 * static_cast<double>(scan.returns.size()));
}

TEST(LeadingEdge, SomethingInFrontOfTheBed_IsNotMovedBackToIt) {
  const auto geometry = fineGeometry();
  cv::Mat image = speckledBed(geometry, 150, 3.0, 5);
  const int bin = static_cast<int>(std::lround(geometry.binAt(2.5)));
  image.col(120).rowRange(bin, bin + 8).setTo(200);
  LeadingEdgeOptions options;
  options.speckleWindow_rad = 2 * test::kDeg;
  const auto scan = findLeadingEdge(image, geometry, options);
  for (const auto& r : scan.returns)
    if (r.beam == 120) {
      EXPECT_NEAR(r.range_m, 2.5, geometry.rangeResolution_m);
    }
}

TEST(LeadingEdge, RidgeBehindTheBed_IsAReturn) {
  const auto geometry = fineGeometry();
  cv::Mat image = speckledBed(geometry, 90, 3.0, 6);
  const int bin = static_cast<int>(std::lround(geometry.binAt(4.0)));
  for (int beam = 110; beam < 130; ++beam) image.col(beam).rowRange(bin, bin + 9).setTo(255);
  LeadingEdgeOptions options;
  options.ridges = true;
  const auto scan = findLeadingEdge(image, geometry, options);
  int found = 0, others = 0;
  for (const auto& r : scan.returns) {
    if (r.order == 0) continue;
    const bool isRidge = r.beam >= 110 && r.beam < 130;
    (isRidge ? found : others) += 1;
    EXPECT_TRUE(r.isRidge);
    // Its middle; neighbouring speckle may add a bin or two to it.
    if (isRidge) {
      EXPECT_NEAR(r.range_m, geometry.range_m(bin + 4), 2 * geometry.rangeResolution_m);
    }
  }
  EXPECT_EQ(found, 20);
  // Speckle alone exceeds twice its mean over seven independent cells with a probability of 1e-4 a cell at the most.
  EXPECT_LE(others, 2);
}

constexpr double kWall_m = 4.5;
constexpr double kWallBegins_rad = 50 * test::kDeg;

/// A wall at y = 4.5 m behind a dim bed, visible from 50 degrees outwards, by beams that see 1.5 degrees to either
/// side.
cv::Mat wallSeenByWideBeams(const PingGeometry& geometry, unsigned seed) {
  cv::Mat image = speckledBed(geometry, 90, 3.0, seed);
  for (int beam = 0; beam < image.cols; ++beam)
    for (int side = -15; side <= 15; ++side) {
      const double bearing_rad = geometry.bearings_rad[static_cast<std::size_t>(beam)] + 0.1 * side * test::kDeg;
      if (bearing_rad < kWallBegins_rad) continue;
      const int bin = static_cast<int>(std::lround(geometry.binAt(kWall_m / std::sin(bearing_rad))));
      image.col(beam).rowRange(bin - 1, bin + 2).setTo(255);
    }
  return image;
}

TEST(LeadingEdge, WallSeenByWideBeams_RidgesLieOnItAlsoWhereItBegins) {
  const auto geometry = fineGeometry();
  const cv::Mat image = wallSeenByWideBeams(geometry, 8);
  LeadingEdgeOptions options;
  options.ridges = true;
  const auto errorsWhereItBegins = [&](const LineScan& scan) {
    std::vector<double> errors;
    for (const auto& r : scan.returns)
      if (r.isRidge && r.bearing_rad > kWallBegins_rad && r.bearing_rad < kWallBegins_rad + 2 * test::kDeg)
        errors.push_back(r.range_m - kWall_m / std::sin(r.bearing_rad));
    return errors;
  };
  const auto each = errorsWhereItBegins(findLeadingEdge(image, geometry, options));
  options.ridgeWindow_rad = 3 * test::kDeg;
  const auto scan = findLeadingEdge(image, geometry, options);
  const auto together = errorsWhereItBegins(scan);
  ASSERT_GE(each.size(), 3u);
  ASSERT_GE(together.size(), 3u);
  // A beam at the wall's begin sees it only on one side, 0.75 deg off in the mean: 6 cm nearer, or the test shows
  // nothing.
  EXPECT_LT(*std::min_element(each.begin(), each.end()), -0.03);
  // A run's centre is known to a quarter of a degree, 2 cm in range, and some ten of them make the line.
  for (const double error : together) EXPECT_LT(std::abs(error), 0.015);
  for (const auto& r : scan.returns)
    if (r.isRidge && r.bearing_rad > kWallBegins_rad) {
      EXPECT_LT(std::abs(r.range_m - kWall_m / std::sin(r.bearing_rad)), 3 * r.rangeSigma_m);
    }
}

TEST(LeadingEdge, WallThatFacesTheSonar_IsMetAtItsDistance) {
  const auto geometry = fineGeometry();
  cv::Mat image = speckledBed(geometry, 90, 3.0, 9);
  std::mt19937 random(10);
  std::normal_distribution<double> noise(0, 1.5);  // bins, by speckle
  for (int beam = 80; beam < 176; ++beam) {
    const double wall_m = 4.5 / std::cos(geometry.bearings_rad[static_cast<std::size_t>(beam)]);
    const int bin = static_cast<int>(std::lround(geometry.binAt(wall_m) + noise(random)));
    image.col(beam).rowRange(bin - 4, bin + 5).setTo(255);
  }
  LeadingEdgeOptions options;
  options.ridges = true;
  options.ridgeWindow_rad = 3 * test::kDeg;
  std::size_t found = 0;
  for (const auto& r : findLeadingEdge(image, geometry, options).returns) {
    if (!r.isRidge) continue;
    ++found;
    // A dozen beams, each off by 1.5 bins of 1.25 cm: 0.5 cm, and 1 cm at the ends where all lie on one side.
    EXPECT_NEAR(r.range_m * std::cos(r.bearing_rad), 4.5, 0.025) << r.beam;
  }
  EXPECT_GT(found, 85u);
}

TEST(LeadingEdge, RidgeOfOneBeamAlone_IsLeftOutAsAGlint) {
  const auto geometry = fineGeometry();
  cv::Mat image = speckledBed(geometry, 90, 3.0, 11);
  image.col(100).rowRange(320, 330).setTo(255);
  LeadingEdgeOptions options;
  options.ridges = true;
  const auto isFound = [&](const LineScan& scan) {
    return std::any_of(scan.returns.begin(), scan.returns.end(),
                       [](const LineReturn& r) { return r.isRidge && r.beam == 100; });
  };
  EXPECT_TRUE(isFound(findLeadingEdge(image, geometry, options)));
  options.ridgeWindow_rad = 3 * test::kDeg;
  EXPECT_FALSE(isFound(findLeadingEdge(image, geometry, options)));
}

TEST(LeadingEdge, BrightBed_HasNoRidge) {
  const auto geometry = fineGeometry();
  const cv::Mat image = speckledBed(geometry, 230, 3.0, 7);
  LeadingEdgeOptions options;
  options.ridges = true;
  for (const auto& r : findLeadingEdge(image, geometry, options).returns) EXPECT_EQ(r.order, 0);
}

TEST(LeadingEdge, RingDown_IsIgnored) {
  cv::Mat image(200, 50, CV_8U, cv::Scalar(0));
  image.rowRange(0, 9).setTo(255);  // up to 0.45 m
  EXPECT_TRUE(findLeadingEdge(image, smallGeometry(), {}).returns.empty());
}

TEST(LeadingEdge, EmptyImage_GivesAnEmptyScan) {
  EXPECT_TRUE(findLeadingEdge(cv::Mat(), PingGeometry{}, {}).returns.empty());
}

}  // namespace
}  // namespace s2s::sonar
