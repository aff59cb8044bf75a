#pragma once

#include <optional>
#include <vector>

#include "s2s/calib/sonar_parameters.h"
#include "s2s/core/trajectory.h"
#include "s2s/obs/CObservationImagingSonar.h"
#include "s2s/sonar/leading_edge.h"

namespace s2s::calib {

/// What follows a first return on its beam: echo strength over range, in units of the return's own.
struct MirrorTrace {
  core::TimeNs time = 0;  ///< as recorded
  float bearing_rad = 0, range_m = 0;
  std::vector<float> strength;  ///< a sample a centimetre, from 30 cm before the return
};

struct WaterMirrorOptions {
  bool enabled = true;
  int beamStep = 4;            ///< one beam in so many is looked at
  double reach_m = 0.15;       ///< the second echo is looked for so far from where it should be
  double minStrength = 0.03;   ///< of the second echo, as a share of the first, ...
  double minExplained = 0.03;  ///< and of what the first alone leaves unexplained
  int minTraces = 500;
  double sigma_m = 0.01;  ///< of the depth so found: errors that all traces share
};

/// Traces of the beams that look ahead rather than down; others have no mirrored way in front of the transducer.
std::vector<MirrorTrace> mirrorTraces(const obs::CObservationImagingSonar& ping, const sonar::LineScan& scan,
                                      const core::Isometry& T_vehicle_sonar, const WaterMirrorOptions& options);

/// How deep below the water the sonar is, told by echoes whose way out or back led over the water surface.
struct MirrorDepth {
  double higher_m = 0;   ///< the sonar is so much higher than the state says
  double strength = 0;   ///< of the second echo as a share of the first
  double explained = 0;  ///< share of what the first echo alone leaves unexplained that the second one explains
  std::size_t traces = 0;
};

/// A surface at range r1 is seen once more at (r1 + r2) / 2, r2 being the distance to its image in the water surface:
/// r2^2 - r1^2 = 4 d D, with d the sonar's and D the surface's depth. So the gap g between both echoes tells d,
/// whatever the seabed's height. The mean trace of all with one expected gap g is taken as
///   S_g(u) = T(u) + a T(u - g - delta),
/// one unknown shape T of echo for all gaps; delta is what the expected gaps are wrong by. Nothing if no second echo
/// stands out: a rough surface gives none.
///
/// @param waterHeight_m of the surface, in the map's frame
std::optional<MirrorDepth> mirrorDepth(const std::vector<MirrorTrace>& traces, const SonarState& sonar,
                                       double soundSpeed_mps, const core::Trajectory& T_map_vehicle,
                                       double waterHeight_m, const WaterMirrorOptions& options);

}  // namespace s2s::calib
