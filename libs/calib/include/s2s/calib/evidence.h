#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "s2s/calib/aperture_ping.h"
#include "s2s/calib/echo_table.h"
#include "s2s/calib/texture.h"
#include "s2s/calib/water_mirror.h"
#include "s2s/core/trajectory.h"

namespace s2s::calib {

/// A vertical plane: normal . (x, y) = offset, in the map's frame.
struct WallPlane {
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();
  double offset_m = 0;
};

/// The wall that stands at a place of the map, if any does.
using WallFinder = std::function<std::optional<WallPlane>(double x_m, double y_m)>;

/// All that a survey has to say about the sonars' mountings.
struct CalibrationEvidence {
  core::Trajectory T_map_vehicle;  ///< z up
  std::vector<PingEchoes> pings;
  std::vector<TexturePing> texture;     ///< of the horizontal sonar; may be empty
  std::vector<AperturePing> aperture;   ///< of the horizontal sonar; may be empty
  std::vector<MirrorTrace> mirror;      ///< of the vertical sonar; may be empty
  std::optional<double> waterHeight_m;  ///< of the surface in the map, as the floating hull tells it
  WallFinder wallAt;                    ///< walls that the LiDAR saw, gone on below the water; may be none
};

}  // namespace s2s::calib
