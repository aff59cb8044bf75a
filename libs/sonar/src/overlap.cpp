#include "s2s/sonar/overlap.h"

#include <algorithm>
#include <cmath>

namespace s2s::sonar {

namespace {

constexpr double kBeamStep_rad = 1.0 * M_PI / 180.0;
constexpr double kRangeStep_m = 0.2;
constexpr int kElevations = 5;

/// What `isInView` needs, with the limits looked up once.
struct View {
  double minBearing_rad, maxBearing_rad, minRange_m, maxRange_m, sinHalfAperture;
  obs::BearingModel model;

  explicit View(const PingGeometry& g)
      : minBearing_rad(g.minBearing_rad()),
        maxBearing_rad(g.maxBearing_rad()),
        minRange_m(g.rangeOffset_m),
        maxRange_m(g.maxRange_m()),
        sinHalfAperture(std::sin(0.5 * g.verticalAperture_rad)),
        model(g.bearingModel) {}

  bool holds(const Eigen::Vector3d& p) const {
    const double range_m = p.norm();
    if (range_m < minRange_m || range_m > maxRange_m || range_m <= 0) return false;
    if (std::abs(p.z()) > range_m * sinHalfAperture) return false;
    if (model == obs::BearingModel::Cone && p.x() < 0) return false;
    const double bearing_rad = sonarCoordinates(p, model).bearing_rad;
    return bearing_rad >= minBearing_rad && bearing_rad <= maxBearing_rad;
  }
};

/// Which bins of one beam of a have an arc that meets b's view: [first, end), widened by one range step.
std::pair<int, int> overlapOfBeam(const PingGeometry& a, std::size_t beam, const View& b, const core::Isometry& T_b_a) {
  std::vector<Eigen::Vector3d> directions_b;
  for (int e = 0; e < kElevations; ++e) {
    const double elevation_rad = (static_cast<double>(e) / (kElevations - 1) - 0.5) * a.verticalAperture_rad;
    directions_b.push_back(T_b_a.linear() * pointAt({1.0, a.bearings_rad[beam], elevation_rad}, a.bearingModel));
  }
  const auto rows = static_cast<int>(a.rangeCount);
  const int step = std::max(1, static_cast<int>(std::lround(kRangeStep_m / a.rangeResolution_m)));
  int first = rows, end = 0;
  for (int row = 0; row < rows + step; row += step) {
    const int bin = std::min(row, rows - 1);
    const double range_m = a.range_m(bin);
    const bool meets = std::any_of(directions_b.begin(), directions_b.end(), [&](const Eigen::Vector3d& d) {
      return b.holds(range_m * d + T_b_a.translation());
    });
    if (!meets) continue;
    first = std::min(first, std::max(0, bin - step));
    end = std::max(end, std::min(rows, bin + step + 1));
  }
  return first < end ? std::make_pair(first, end) : std::make_pair(0, 0);
}

void widen(std::pair<int, int>& interval, const std::pair<int, int>& by) {
  if (by.first == by.second) return;
  if (interval.first == interval.second) {
    interval = by;
    return;
  }
  interval.first = std::min(interval.first, by.first);
  interval.second = std::max(interval.second, by.second);
}

}  // namespace

bool isInView(const PingGeometry& geometry, const Eigen::Vector3d& p_sonar) { return View(geometry).holds(p_sonar); }

Overlap findOverlap(const PingGeometry& a, const PingGeometry& b, const core::Isometry& T_b_a) {
  Overlap overlap;
  const std::size_t beams = a.beamCount();
  overlap.bins.assign(beams, {0, 0});
  if (beams == 0 || a.rangeCount == 0 || b.beamCount() == 0) return overlap;

  const View view(b);
  const double width_rad = (a.maxBearing_rad() - a.minBearing_rad()) / static_cast<double>(beams);
  // A single beam has no width.
  const auto step = static_cast<std::size_t>(
      std::clamp(std::round(kBeamStep_rad / std::max(width_rad, 1e-9)), 1.0, static_cast<double>(beams)));
  for (std::size_t b0 = 0; b0 < beams + step; b0 += step) {
    const std::size_t beam = std::min(b0, beams - 1);
    const auto interval = overlapOfBeam(a, beam, view, T_b_a);
    const std::size_t from = beam >= step ? beam - step : 0, to = std::min(beams - 1, beam + step);
    for (std::size_t i = from; i <= to; ++i) widen(overlap.bins[i], interval);
  }

  ImageRegion& region = overlap.region;
  region = {static_cast<int>(beams), 0, static_cast<int>(a.rangeCount), 0};
  for (std::size_t beam = 0; beam < beams; ++beam) {
    const auto& interval = overlap.bins[beam];
    if (interval.first == interval.second) continue;
    region.firstBeam = std::min(region.firstBeam, static_cast<int>(beam));
    region.endBeam = std::max(region.endBeam, static_cast<int>(beam) + 1);
    region.firstBin = std::min(region.firstBin, interval.first);
    region.endBin = std::max(region.endBin, interval.second);
  }
  if (region.empty()) region = {};
  return overlap;
}

}  // namespace s2s::sonar
