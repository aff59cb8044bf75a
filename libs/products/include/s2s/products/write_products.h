#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "s2s/core/trajectory.h"
#include "s2s/products/point_source.h"
#include "s2s/products/products_options.h"
#include "s2s/products/run_summary.h"

namespace s2s::map {
class CSeabedSkyMap;
}

namespace s2s::products {

/// The vehicle's paths of a run.
struct Trajectories {
  core::Trajectory optimised;  ///< T_map_vehicle at sweep rate or better
  core::Trajectory odometry;   ///< T_odom_vehicle
  core::Trajectory keyframes;  ///< T_map_vehicle
};

struct WrittenFile {
  std::string name;  ///< within the output folder
  std::uint64_t bytes = 0;
};

struct ProductsResult {
  std::vector<WrittenFile> files;  ///< in the order in which they were written
  RunSummary summary;              ///< as in `summary.json`: points counted, times and peak memory up to date
  SeabedGridStatistics seabed;     ///< zero if no grid was asked for
};

/// Writes everything that `options` asks for into the folder `dir`, each file whole or not at all. The points are run
/// through twice; memory does not grow with their number, except for the decimated `.3Dscene` and `.simplemap`.
///
/// A product that the data cannot give (a seabed grid without soundings) is left out, and a warning in the summary says
/// so.
/// @param summary what the mapper knows of its run; the rest is added here
/// @param onFile  is called with each file's name before it is written, for progress
/// @param surface the map's own surface, for the seabed grid; null: it is estimated from the points
/// @param walls   the map's walls; null: there is no `walls.ply`
/// @throws core::OutputError if the folder cannot be written to
ProductsResult writeProducts(const PointSource& points, const Trajectories& trajectories, RunSummary summary,
                             const ProductsOptions& options, const std::string& dir,
                             const std::function<void(const std::string&)>& onFile = {},
                             const map::SurfaceEstimator* surface = nullptr, const map::WallEstimator* walls = nullptr);

/// The same with the points and the surface of a map.
ProductsResult writeProducts(const map::CSeabedSkyMap& map, const Trajectories& trajectories, RunSummary summary,
                             const ProductsOptions& options, const std::string& dir,
                             const std::function<void(const std::string&)>& onFile = {});

}  // namespace s2s::products
