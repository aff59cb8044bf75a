#pragma once

#include <optional>
#include <string>

#include "s2s/core/trajectory.h"
#include "s2s/map/map_point.h"
#include "s2s/products/height_grid.h"

namespace s2s::eval {

/// The files of a map that seabed-sky-map made, read when asked for.
class MapFolder {
 public:
  /// @throws core::InputError if there is no such folder or it holds no trajectory.tum
  explicit MapFolder(std::string path);

  /// T_map_vehicle, optimised.
  /// @throws core::InputError
  core::Trajectory trajectory() const;
  /// T_odom_vehicle; nothing if the file is absent.
  std::optional<core::Trajectory> odometry() const;
  /// `<layer>.ply` or `map_<layer>.ply`; nothing if neither is there.
  std::optional<std::string> layerFile(map::Layer layer) const;
  /// walls.ply; nothing if it is absent.
  std::optional<std::string> wallFile() const { return existing("walls.ply"); }
  /// seabed.tif; nothing if it is absent.
  std::optional<products::HeightGrid> seabed() const;
  /// `water_height_m` of summary.json, the height of the water surface in the map frame; nothing if it is not stated.
  /// @throws core::InputError if the file is there but damaged
  std::optional<double> waterHeight_m() const;

 private:
  std::optional<std::string> existing(const std::string& name) const;

  std::string path_;
};

}  // namespace s2s::eval
