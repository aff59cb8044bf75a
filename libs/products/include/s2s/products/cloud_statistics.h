#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "s2s/map/map_point.h"

namespace s2s::products {

/// What the writers need to know of a map before they begin, gathered in one pass. Points with a coordinate that is not
/// finite are counted apart and enter nothing else.
class CloudStatistics {
 public:
  struct LayerStatistics {
    std::uint64_t count = 0;
    std::uint64_t notFinite = 0;
    double maxIntensity = 0;
    Eigen::AlignedBox3d box;
  };

  /// @return false if the point is not finite
  bool add(const map::MapPoint& point);

  const LayerStatistics& layer(map::Layer layer) const { return layers_[static_cast<std::size_t>(layer)]; }
  std::uint64_t count() const;
  std::uint64_t notFinite() const;
  /// Empty (`isEmpty()`) without points.
  Eigen::AlignedBox3d box() const;
  /// Height below which the share `quantile` of the layers' points lies, to 0.1 m; 0 without points.
  double heightQuantile_m(const std::vector<map::Layer>& layers, double quantile) const;

 private:
  std::array<LayerStatistics, map::kLayers.size()> layers_;
  std::array<std::vector<std::uint64_t>, map::kLayers.size()> heights_;  ///< histograms of 0.1 m, ends gather the rest
};

}  // namespace s2s::products
