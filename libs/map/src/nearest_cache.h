#pragma once

#include <mrpt/maps/CSimplePointsMap.h>

#include <mutex>

namespace s2s::map {

/// The LiDAR layer as a thinned MRPT point map with its search tree, made at the first question.
struct NearestCache {
  std::once_flag made;
  mrpt::maps::CSimplePointsMap map;
};

}  // namespace s2s::map
