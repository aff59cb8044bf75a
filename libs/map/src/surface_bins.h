#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "s2s/core/time.h"

namespace s2s::map {

// The histogram of a surface's cell: of heights for a seabed, of distances for a wall ("values" below). Any value can
// be taken out again exactly.

constexpr double kBinsPerMetre = 100;

/// Values of a cell within one centimetre.
struct SurfaceBin {
  std::int32_t height_cm = 0;
  std::uint32_t count = 0;
  double weight = 0;          ///< sum of 1/sigma²
  double weightedHeight = 0;  ///< sum of value/sigma²
};
using SurfaceBins = std::vector<SurfaceBin>;  ///< in order of value

struct SurfaceColumn {
  SurfaceBins bins;
  std::uint32_t pings = 0;  ///< changes of the values' time: they come ping by ping
  core::TimeNs lastAdded = 0, lastRemoved = 0;
};

double totalWeight(const SurfaceBins& bins);
std::uint32_t totalCount(const SurfaceBins& bins);
/// Index of the bin in which the cumulative weight passes the share `quantile`.
std::size_t quantileBin(const SurfaceBins& bins, double quantile);

struct SurfaceMiddle {
  double value_m = 0, sigma_m = 0;
};
/// The weighted median and the standard deviation of a single ping's value (see SurfaceEstimator).
/// @pre there is a bin
SurfaceMiddle middleOf(const SurfaceBins& bins, std::uint32_t pings);

/// Adds a value (`sign` 1) or takes out one that was added (-1).
void enterValue(SurfaceColumn& column, double value_m, double sigma_m, core::TimeNs time, int sign);

}  // namespace s2s::map
