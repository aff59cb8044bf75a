#pragma once

#include <cstdint>

#include "s2s/map/surface_estimator.h"
#include "s2s/products/height_grid.h"

namespace s2s::products {

struct SeabedGridOptions : map::SurfaceOptions {
  double maxStep_m = 1.0;          ///< a cell that differs more from its neighbours' median is no seabed
  double maxDoubtfulStep_m = 0.4;  ///< the same for a cell that holds more than seabed
  int maxCells = 100'000'000;      ///< a larger grid is refused
};

/// What became of the soundings and cells.
struct SeabedGridStatistics : map::SurfaceStatistics {
  std::uint64_t cells = 0;  ///< with a height
  std::uint64_t steps = 0;  ///< cells that disagreed with their neighbours
  double area_m2 = 0;
  double minHeight_m = 0, maxHeight_m = 0;
};

/// The cells of a surface as a grid, without those that disagree with their neighbours: a moored hull, say.
///
/// @param waterHeight_m height of the water surface in the map frame
/// @throws core::OutputError if the grid would have more than `maxCells`
HeightGrid gridOf(const map::SurfaceEstimator& surface, double waterHeight_m, const SeabedGridOptions& options,
                  SeabedGridStatistics* statistics = nullptr);

}  // namespace s2s::products
