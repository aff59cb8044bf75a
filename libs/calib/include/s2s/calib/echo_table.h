#pragma once

#include <cstdint>
#include <vector>

#include "s2s/calib/sonar_parameters.h"
#include "s2s/calib/swath.h"
#include "s2s/core/time.h"
#include "s2s/sonar/leading_edge.h"

namespace s2s::calib {

/// What a measured range means.
enum class EchoKind : std::uint8_t {
  NearEdge = 0,     ///< the band begins: the lower edge of the aperture meets the seabed
  FarEdge = 1,      ///< the band ends: the upper edge meets it
  Middle = 2,       ///< a point of the aperture, met at the range of a band's centre
  Band = 4,         ///< the same, as one: the mean over the aperture is that of the two points of Gauss' quadrature
  ApertureEnd = 5,  ///< on the bed at the aperture's end, as a mean profile over elevation tells it
  Ridge = 3         ///< stands out of the bed's echo: of a wall behind it, at an unknown elevation
};

struct Echo {
  float bearing_rad = 0, range_m = 0;
  EchoKind kind = EchoKind::Middle;
  /// Elevation as a share of half the (corrected) aperture: -1 and +1 are its edges.
  float elevationShare = 0;
};

/// One ping, reduced to what the calibration needs.
struct PingEchoes {
  core::TimeNs time = 0;  ///< as recorded
  SonarId sonar = SonarId::Horizontal;
  std::vector<Echo> echoes;
};

/// Turns bands into echoes by how the imaging plane lies to the water.
///
/// A plane that crosses the vertical by more than the aperture (the horizontal sonar's, pitched down) meets the seabed
/// with the aperture's lower edge first and its upper edge last. A nearly upright plane (the vertical sonar's) meets it
/// at all elevations at about one range: the centre of the band is the mean over the aperture, that of the two points
/// of Gauss' quadrature, +-1/sqrt(3) of half the aperture. Neither of them alone need lie on the bed: under a plane
/// that leans one is above it, the other below.
std::vector<Echo> echoesOf(const std::vector<Swath>& swaths, const core::Isometry& T_vehicle_sonar, double aperture_rad,
                           double maxRange_m);

/// First returns of a sonar whose plane crosses the vertical as near edges, one beam in `beamStep`, and the ridges
/// behind them. They are those of the map, so what the calibration calls the aperture's edge is what the map takes for
/// it.
std::vector<Echo> returnsOf(const sonar::LineScan& scan, const core::Isometry& T_vehicle_sonar, int beamStep);

}  // namespace s2s::calib
