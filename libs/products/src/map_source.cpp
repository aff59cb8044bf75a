#include "s2s/products/map_source.h"

#include "s2s/map/CSeabedSkyMap.h"

namespace s2s::products {

PointSource pointsOf(const map::CSeabedSkyMap& map) {
  return [&map](map::Layer layer, const PointVisitor& visit) { map.forEachPoint(layer, visit); };
}

}  // namespace s2s::products
