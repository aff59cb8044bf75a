#pragma once

#include <array>
#include <cstddef>

#include "s2s/core/trajectory.h"
#include "s2s/eval/hydrographic_order.h"
#include "s2s/eval/mesh_query.h"
#include "s2s/eval/statistics.h"
#include "s2s/products/height_grid.h"

namespace s2s::eval {

struct SeabedErrorOptions {
  int raysPerSide = 5;          ///< a cell is compared with the mean of this many squared rays spread over it
  double coverageRadius_m = 5;  ///< seabed nearer than this to the path (horizontally) ought to be in the map
};

/// A map's seabed grid against the true seabed; errors are map minus truth, positive where the map is too high.
struct SeabedError {
  std::size_t cells = 0;         ///< with a height and with seabed under them
  std::size_t withoutTruth = 0;  ///< with a height but no seabed under them; not counted in the errors
  double bias_m = 0;             ///< mean error
  double rmse_m = 0;
  double std_m = 0;
  double p95_m = 0;                                              ///< 95th percentile of the error's magnitude
  double max_m = 0;                                              ///< largest magnitude
  std::array<double, kHydrographicOrders.size()> withinOrder{};  ///< share of cells, in the order of the standard
  double withinTwoSigma = 0;  ///< share of cells whose error is at most twice the sigma the grid states
  double meanDepth_m = 0;     ///< true, below z = 0
  std::size_t trueCells = 0;  ///< cells' worth of true seabed near the path
  double coverage = 0;        ///< share of these where the map has a height
};

/// Compares each cell, taken into the world by `T_world_map`, with the topmost surface of `seabed` above or below it.
/// @param seabed the true seabed and what lies on it
/// @param trajectory_world where the vessel went; for the coverage
SeabedError compareSeabed(const products::HeightGrid& grid, const core::Isometry& T_world_map, const MeshQuery& seabed,
                          const core::Trajectory& trajectory_world, const SeabedErrorOptions& options);

}  // namespace s2s::eval
