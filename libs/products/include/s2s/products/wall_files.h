#pragma once

#include <string>
#include <vector>

#include "s2s/map/wall_estimator.h"

namespace s2s::products {

/// Area of the walls' faces by the sensor that saw them.
struct WallStatistics {
  double lidarArea_m2 = 0;
  double sonarArea_m2 = 0;
};

std::vector<map::WallEstimator::Cell> wallCells(const map::WallEstimator& walls);
WallStatistics wallStatistics(const std::vector<map::WallEstimator::Cell>& cells, double cell_m);

/// Binary little-endian PLY, a vertex for each cell: double x y z, float nx ny nz (outward), float offset, float sigma
/// (m), uint count, uchar source (0 LiDAR, 1 sonar).
/// @throws core::OutputError
void writeWallPly(const std::string& path, const std::vector<map::WallEstimator::Cell>& cells);

}  // namespace s2s::products
