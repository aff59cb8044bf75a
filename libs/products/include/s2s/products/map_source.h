#pragma once

#include "s2s/products/point_source.h"

namespace s2s::map {
class CSeabedSkyMap;
}

namespace s2s::products {

/// The points of a map, which must outlive the source.
PointSource pointsOf(const map::CSeabedSkyMap& map);

}  // namespace s2s::products
