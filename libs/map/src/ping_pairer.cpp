#include "ping_pairer.h"

#include <cmath>

#include "s2s/map/sonar_scans.h"

namespace s2s::map {

std::optional<PingPairer::StereoScan> PingPairer::add(const PlacedPing& ping, bool isVertical, double window_s) {
  (isVertical ? lastVertical_ : lastHorizontal_) = ping;
  if (!lastHorizontal_ || !lastVertical_) return std::nullopt;
  const PlacedPing &h = *lastHorizontal_, &v = *lastVertical_;
  if (std::abs(core::secondsBetween(h.pose.time, v.pose.time)) > window_s) return std::nullopt;
  const core::Isometry T_h_v = (h.T_map_vehicle * h.T_vehicle_sonar).inverse() * v.T_map_vehicle * v.T_vehicle_sonar;
  StereoScan scan;
  scan.pose = h.pose;
  scan.pose.layer = Layer::Stereo;
  scan.points = toScanPoints(stereo_.process(h.processed, v.processed, T_h_v).points, h.T_vehicle_sonar);
  lastHorizontal_.reset();
  lastVertical_.reset();
  if (scan.points.empty()) return std::nullopt;
  return scan;
}

}  // namespace s2s::map
