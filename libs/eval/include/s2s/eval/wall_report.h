#pragma once

#include <optional>
#include <string>
#include <vector>

#include "s2s/eval/wall_similarity.h"
#include "s2s/map/map_point.h"

namespace s2s::eval {

struct WallReportOptions {
  WallOptions wall;  ///< `waterHeight_m` and `sonarMinHeight_m` are set from what follows
  std::vector<map::Layer> sonarLayers = map::kSonarLayers;
  std::optional<double> waterHeight_m;    ///< in the map frame; by default that of summary.json
  std::optional<double> sonarMaxDepth_m;  ///< below the water surface
  std::string truthFolder;                ///< if not empty, the ends of the wall are in its world frame
};

/// Compares a wall of a map folder; see `compareWall`.
/// @throws core::InputError also if the water height is not known or a layer's file is missing
WallReport evaluateWall(const std::string& mapFolder, const WallReportOptions& options);

}  // namespace s2s::eval
