#include <gtest/gtest.h>

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
