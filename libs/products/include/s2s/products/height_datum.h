#pragma once

#include <string>

namespace s2s::products {

/// The height that pictures count from: the water surface where it is known, else, as on land, the middle height of
/// the path.
struct HeightDatum {
  double height_m = 0;  ///< in the map frame
  bool isWater = true;

  /// What heights are counted from, as in "height above water".
  std::string name() const { return isWater ? "water" : "the path"; }
};

}  // namespace s2s::products
