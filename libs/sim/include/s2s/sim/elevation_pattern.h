#pragma once

#include <vector>

#include "s2s/sim/sonar_options.h"

namespace s2s::sim {

/// One-way power pattern across the imaging plane, 1 on it:
///   rectangle  1 inside the aperture, 0 outside
///   sinc       a uniform line element whose -3 dB width is the aperture (two-way -26 dB side lobes)
///   shaped     1 / (1 + (e / e0)^16): a shaded element, flat inside and steep at its edge e0 = aperture / 2 (-3 dB),
///              with side lobes of `elevationSideLobe_db` outside
double elevationPattern(const SonarOptions& options, double elevation_rad);

/// Edges of the elevation samples of a ping, rising: dense over the main lobe, coarse over the side lobes.
std::vector<double> elevationEdges(const SonarOptions& options);

}  // namespace s2s::sim
