#include "s2s/sim/elevation_pattern.h"

#include <cmath>

#include "s2s/sim/beam_pattern.h"

namespace s2s::sim {

namespace {

constexpr double kMaxElevation_rad = 75 * M_PI / 180;
constexpr double kMainLobe = 0.7;  // of the aperture on each side; beyond it samples may be coarse
constexpr int kSideSamples = 14;   // on each side

}  // namespace

double elevationPattern(const SonarOptions& o, double elevation_rad) {
  const double edge = 0.5 * o.aperture_rad;
  switch (o.elevationPattern) {
    case ElevationPattern::Rectangle:
      return std::abs(elevation_rad) <= edge ? 1 : 0;
    case ElevationPattern::Sinc: {
      const double p = arrayPattern(halfPowerPoint(1) * std::sin(elevation_rad) / std::sin(edge), 1);
      return p * p;
    }
    case ElevationPattern::Shaped: {
      const double u = std::abs(elevation_rad) / edge;
      const double lobe = std::sin(1.5 * M_PI * u);
      const double side = u > 1 ? std::pow(10, 0.1 * o.elevationSideLobe_db) * lobe * lobe : 0;
      return std::max(1 / (1 + std::pow(u, 16)), side);
    }
  }
  return 0;
}

std::vector<double> elevationEdges(const SonarOptions& o) {
  const bool wedge = o.elevationPattern == ElevationPattern::Rectangle;
  const double main = wedge ? 0.5 * o.aperture_rad : kMainLobe * o.aperture_rad;
  const double end = std::max(main, std::min(kMaxElevation_rad, 4 * o.aperture_rad));
  std::vector<double> edges;
  if (!wedge)
    for (int i = 0; i < kSideSamples; ++i) edges.push_back(-end + (end - main) * i / kSideSamples);
  for (int i = 0; i <= o.elevationRays; ++i) edges.push_back(-main + 2 * main * i / o.elevationRays);
  if (!wedge)
    for (int i = 1; i <= kSideSamples; ++i) edges.push_back(main + (end - main) * i / kSideSamples);
  return edges;
}

}  // namespace s2s::sim
