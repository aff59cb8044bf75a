#pragma once

#include <vector>

#include "s2s/map/CSeabedSkyMap.h"

namespace s2s::test {

/// Keeps every LiDAR point, however near and however close to another.
inline map::MapOptions keepAll() {
  map::MapOptions options;
  options.insertion.lidarVoxel_m = 0;
  options.insertion.lidarMinRange_m = 0;
  return options;
}

inline std::vector<map::MapPoint> pointsOf(const map::CSeabedSkyMap& map, map::Layer layer) {
  std::vector<map::MapPoint> points;
  map.forEachPoint(layer, [&points](const map::MapPoint& p) { points.push_back(p); });
  return points;
}

}  // namespace s2s::test
