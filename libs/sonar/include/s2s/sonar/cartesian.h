#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "s2s/core/transform.h"
#include "s2s/sonar/ping_geometry.h"

namespace s2s::sonar {

/// Paper, equation (1): pixel centres on the imaging plane (zero elevation), in the sonar's frame.
Eigen::Vector3d planePoint(const PingGeometry& geometry, double bin, double beam);

/// Pixels of a Cartesian picture of the imaging plane: row 0 is the far edge, x points up, y to the left, as seen by
/// somebody looking along with the sonar.
struct CartesianGrid {
  double resolution_m = 0.02;
  double maxX_m = 0, minX_m = 0;
  double maxY_m = 0, minY_m = 0;

  int rows() const { return static_cast<int>(std::ceil((maxX_m - minX_m) / resolution_m)); }
  int columns() const { return static_cast<int>(std::ceil((maxY_m - minY_m) / resolution_m)); }
  /// Centre of a pixel, (x, y) in metres.
  Eigen::Vector2d at(double row, double column) const {
    return {maxX_m - (row + 0.5) * resolution_m, maxY_m - (column + 0.5) * resolution_m};
  }
  /// Fractional (row, column) of a point.
  Eigen::Vector2d pixelOf(const Eigen::Vector2d& p) const {
    return {(maxX_m - p.x()) / resolution_m - 0.5, (maxY_m - p.y()) / resolution_m - 0.5};
  }
};

/// The grid that just holds the fan of a ping.
CartesianGrid gridFor(const PingGeometry& geometry, double resolution_m);

/// Polar image (rows = range bins, columns = beams) to Cartesian, bilinear; 0 outside the fan.
cv::Mat toCartesian(const cv::Mat& polar, const PingGeometry& geometry, const CartesianGrid& grid);

}  // namespace s2s::sonar
