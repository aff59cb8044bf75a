#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "s2s/sonar/cartesian.h"
#include "synthetic_pings.h"

namespace s2s::sonar {
namespace {

TEST(Cartesian, BrightPixel_LandsWhereItsPointIs) {
  const auto geometry = geometryOf(test::emptyPing(256, 400, 60 * test::kDeg));
  cv::Mat polar(400, 256, CV_8U, cv::Scalar(0));
  cv::circle(polar, {180, 250}, 4, cv::Scalar(255), cv::FILLED);
  const auto grid = gridFor(geometry, 0.02);
  const cv::Mat cartesian = toCartesian(polar, geometry, grid);
  const cv::Moments m = cv::moments(cartesian);
  const Eigen::Vector2d center = grid.at(m.m01 / m.m00, m.m10 / m.m00);
  // The blob's centre of mass, with cells that grow with range: to half a grid cell.
  EXPECT_LT((center - planePoint(geometry, 250, 180).head<2>()).norm(), 0.01);
}

TEST(Cartesian, Grid_PixelAndPointAreInverse) {
  const auto grid = gridFor(geometryOf(test::emptyPing()), 0.05);
  const Eigen::Vector2d pixel = grid.pixelOf(grid.at(12, 34));
  EXPECT_NEAR(pixel.x(), 12, 1e-9);
  EXPECT_NEAR(pixel.y(), 34, 1e-9);
}

}  // namespace
}  // namespace s2s::sonar
