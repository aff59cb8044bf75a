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

TEST(Cartesian, ThereAndBack_KeepsASmoothImage) {
  const auto geometry = geometryOf(test::emptyPing(256, 300, 60 * test::kDeg));
  cv::Mat polar(300, 256, CV_8U);
  for (int r = 0; r < polar.rows; ++r)
    for (int c = 0; c < polar.cols; ++c)
      polar.at<std::uint8_t>(r, c) = static_cast<std::uint8_t>(128 + 60 * std::sin(r / 20.0) + 50 * std::cos(c / 30.0));
  const auto grid = gridFor(geometry, 0.01);
  const cv::Mat back = toPolar(toCartesian(polar, geometry, grid), grid, geometry);
  const cv::Rect inner(20, 60, 216, 220);  // near the apex beams are finer than the grid, and edges mix with nothing
  cv::Mat difference;
  cv::absdiff(polar(inner), back(inner), difference);
  double worst = 0;
  cv::minMaxIdx(difference, nullptr, &worst);
  EXPECT_LE(worst, 4);  // two bilinear steps over slopes of 3 levels a pixel
}

TEST(Cartesian, PlanePointInOtherFrame_FollowsAnyPose) {
  const auto geometry = geometryOf(test::emptyPing(11, 100, 100 * test::kDeg));
  const core::Isometry T = core::isometryFromXyzYpr(0.1, -0.2, 0.3, 0.4, -0.5, 0.6);
  const Eigen::Vector3d p = planePoint(geometry, 49.5, 5);
  EXPECT_NEAR(p.x(), 5.0, 1e-9);  // the middle beam, half of 10 m
  EXPECT_LT((planePointIn(T, geometry, 49.5, 5) - T * Eigen::Vector3d(5, 0, 0)).norm(), 1e-6);  // bearings are floats
}

TEST(Cartesian, Grid_PixelAndPointAreInverse) {
  const auto grid = gridFor(geometryOf(test::emptyPing()), 0.05);
  const Eigen::Vector2d pixel = grid.pixelOf(grid.at(12, 34));
  EXPECT_NEAR(pixel.x(), 12, 1e-9);
  EXPECT_NEAR(pixel.y(), 34, 1e-9);
}

}  // namespace
}  // namespace s2s::sonar
