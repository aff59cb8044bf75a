#include "s2s/sonar/cartesian.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace s2s::sonar {

namespace {

double bearingAt(const PingGeometry& geometry, double beam) {
  const double last = static_cast<double>(geometry.beamCount()) - 1;
  const double clamped = std::clamp(beam, 0.0, last);
  const auto i = static_cast<std::size_t>(std::min(std::floor(clamped), std::max(0.0, last - 1)));
  if (geometry.beamCount() < 2) return geometry.bearings_rad.front();
  const double u = clamped - static_cast<double>(i);
  return (1 - u) * geometry.bearings_rad[i] + u * geometry.bearings_rad[i + 1];
}

}  // namespace

Eigen::Vector3d planePoint(const PingGeometry& geometry, double bin, double beam) {
  return pointAt({geometry.range_m(bin), bearingAt(geometry, beam), 0}, geometry.bearingModel);
}

CartesianGrid gridFor(const PingGeometry& geometry, double resolution_m) {
  CartesianGrid grid;
  grid.resolution_m = resolution_m;
  const double range_m = geometry.maxRange_m();
  const double low = geometry.minBearing_rad(), high = geometry.maxBearing_rad();
  grid.maxX_m = range_m;
  grid.minX_m = std::min(0.0, range_m * std::min(std::cos(low), std::cos(high)));
  const auto widest = [range_m](double bearing) { return range_m * std::sin(std::clamp(bearing, -M_PI_2, M_PI_2)); };
  grid.minY_m = std::min(0.0, widest(low));
  grid.maxY_m = std::max(0.0, widest(high));
  return grid;
}

cv::Mat toCartesian(const cv::Mat& polar, const PingGeometry& geometry, const CartesianGrid& grid) {
  cv::Mat beams(grid.rows(), grid.columns(), CV_32F), bins(grid.rows(), grid.columns(), CV_32F);
  for (int row = 0; row < grid.rows(); ++row)
    for (int column = 0; column < grid.columns(); ++column) {
      const Eigen::Vector2d p = grid.at(row, column);
      const double beam = geometry.beamAt(std::atan2(p.y(), p.x()));
      beams.at<float>(row, column) = beam < 0 ? -10.0f : static_cast<float>(beam);
      bins.at<float>(row, column) = static_cast<float>(geometry.binAt(p.norm()));
    }
  cv::Mat cartesian;
  cv::remap(polar, cartesian, beams, bins, cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar(0));
  return cartesian;
}

}  // namespace s2s::sonar
