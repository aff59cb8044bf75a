#pragma once

#include <memory>
#include <string>

#include "s2s/graph/graph_slam_options.h"

namespace s2s::mapper {

/// Reads the keyframes of a map made before (`keyframes.tum`) with their clouds (`lidar.ply`, whose points carry their
/// keyframe's time).
/// @param folder output folder of an earlier run
/// @throws core::InputError if a file is missing or damaged, or if no point belongs to a keyframe
std::unique_ptr<graph::PriorMap> loadPriorMap(const std::string& folder, const graph::GraphSlamOptions& options);

}  // namespace s2s::mapper
