#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "s2s/core/time.h"

namespace s2s::map {

/// Where a point of the map comes from.
enum class Layer : std::uint8_t {
  Lidar = 0,           ///< LiDAR return
  Stereo = 1,          ///< triangulated from a pair of sonar pings
  LineHorizontal = 2,  ///< leading edge of the horizontal sonar
  LineVertical = 3     ///< leading edge of the vertical sonar
};

constexpr std::array<Layer, 4> kLayers = {Layer::Lidar, Layer::Stereo, Layer::LineHorizontal, Layer::LineVertical};
inline const std::vector<Layer> kSonarLayers = {Layer::Stereo, Layer::LineHorizontal, Layer::LineVertical};

/// "lidar", "stereo", "line_horizontal", "line_vertical": the names used in files and in `summary.json`.
constexpr const char* layerName(Layer layer) {
  constexpr std::array<const char*, 4> kNames = {"lidar", "stereo", "line_horizontal", "line_vertical"};
  return kNames[static_cast<std::size_t>(layer)];
}

/// One point of the finished map.
struct MapPoint {
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();  ///< metres
  float intensity = 0;                              ///< LiDAR: reflectivity; sonar: preprocessed echo strength 0..255
  float sigma_m = 0;                                ///< standard deviation, metres: see share/docs/map.md
  /// Length of the arc on which the point may lie as well, as nothing decides; 0: it is decided.
  float interval_m = 0;
  bool isWall = false;  ///< known to lie on a wall and not on the seabed
  core::TimeNs time = 0;
  Layer layer = Layer::Lidar;
};

}  // namespace s2s::map
