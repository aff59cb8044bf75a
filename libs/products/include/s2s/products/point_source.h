#pragma once

#include <functional>

#include "s2s/map/map_point.h"

namespace s2s::products {

using PointVisitor = std::function<void(const map::MapPoint&)>;

/// Calls the visitor with every point of one layer, always in the same order. The writers take their points from it, so
/// that none of them holds a copy of the map; they may run through a layer several times.
using PointSource = std::function<void(map::Layer, const PointVisitor&)>;

}  // namespace s2s::products
