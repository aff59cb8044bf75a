#include "s2s/map/free_space.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "s2s/sonar/ping_geometry.h"

namespace s2s::map {

namespace {

/// The edge of an aperture is no sharp line: this much of it at either side proves nothing.
constexpr double kApertureMargin_rad = 1.0 * M_PI / 180.0;

}  // namespace

void FreeSpace::clear() { *this = FreeSpace(); }

void FreeSpace::add(const StoredLineScan& scan, const core::Isometry& T_map_sonar) {
  const auto layer = static_cast<std::size_t>(scan.pose.layer);
  const Eigen::Vector3d origin = T_map_sonar.translation();
  if (scan.returns.empty() || (hasLast_[layer] && (origin - last_m_[layer]).norm() < kSpacing_m)) return;
  last_m_[layer] = origin;
  hasLast_[layer] = true;

  const auto [low, high] =
      std::minmax_element(scan.returns.begin(), scan.returns.end(),
                          [](const auto& a, const auto& b) { return a.bearing_rad < b.bearing_rad; });
  Ping ping;
  ping.origin_m = origin;
  ping.R_sonar_map = T_map_sonar.linear().transpose().cast<float>();
  ping.aperture_rad = scan.verticalAperture_rad;
  ping.model = scan.bearingModel;
  ping.firstBearing_rad = low->bearing_rad;
  ping.sector_rad = std::max(1e-6f, (high->bearing_rad - low->bearing_rad) / kSectors);
  ping.free_cm.assign(kSectors, std::numeric_limits<std::uint16_t>::max());
  double reach_m = 0;
  for (const PackedReturn& r : scan.returns) {
    if (r.order > 0) continue;
    const double free_m = std::max(0.0, r.range_m - 3 * decodeSigma(r.rangeSigmaCode));
    const auto sector = std::min<std::size_t>(
        kSectors - 1, static_cast<std::size_t>((r.bearing_rad - ping.firstBearing_rad) / ping.sector_rad));
    ping.free_cm[sector] = std::min(ping.free_cm[sector], static_cast<std::uint16_t>(100 * free_m));
    reach_m = std::max(reach_m, free_m);
  }
  for (std::uint16_t& free_cm : ping.free_cm)
    if (free_cm == std::numeric_limits<std::uint16_t>::max()) free_cm = 0;
  const auto index = static_cast<std::uint32_t>(pings_.size());
  pings_.push_back(std::move(ping));
  for (std::int32_t ix = nearby_.index(origin.x() - reach_m); ix <= nearby_.index(origin.x() + reach_m); ++ix)
    for (std::int32_t iy = nearby_.index(origin.y() - reach_m); iy <= nearby_.index(origin.y() + reach_m); ++iy)
      nearby_.at(ix, iy).pings.push_back(index);
}

bool FreeSpace::isFree(const Eigen::Vector3d& p_map, double margin_m, int pings) const {
  SparseGrid<Near>::Hint hint;
  const Near* near = nearby_.find(nearby_.index(p_map.x()), nearby_.index(p_map.y()), hint);
  if (!near) return false;
  int found = 0;
  for (const std::uint32_t index : near->pings)
    if (isFreeFor(pings_[index], p_map, margin_m) && ++found >= pings) return true;
  return false;
}

bool FreeSpace::isFreeFor(const Ping& ping, const Eigen::Vector3d& p_map, double margin_m) const {
  const Eigen::Vector3f p = ping.R_sonar_map * (p_map - ping.origin_m).cast<float>();
  if (p.x() <= 0) return false;
  const auto c = sonar::sonarCoordinates(p.cast<double>(), ping.model);
  if (std::abs(c.elevation_rad) > 0.5 * ping.aperture_rad - kApertureMargin_rad) return false;
  const double sector = (c.bearing_rad - ping.firstBearing_rad) / ping.sector_rad;
  if (sector < 0 || sector >= static_cast<double>(kSectors)) return false;
  return c.range_m + margin_m < 0.01 * ping.free_cm[static_cast<std::size_t>(sector)];
}

}  // namespace s2s::map
