#include "gnss_summary.h"

#include <mrpt/core/format.h>

#include <cmath>

namespace s2s::mapper {

namespace {

products::GnssPlace mapOrigin(const core::Isometry& T_enu_map, const GeodeticPosition& origin) {
  const GeodeticPosition place = toGeodetic(T_enu_map.translation(), origin);
  const Eigen::Vector3d x_enu = T_enu_map.linear().col(0);
  double azimuth_deg = std::atan2(x_enu.x(), x_enu.y()) * 180 / M_PI;  // clockwise from north
  if (azimuth_deg < 0) azimuth_deg += 360;
  return {place.latitude_deg, place.longitude_deg, place.height_m, azimuth_deg};
}

}  // namespace

std::optional<products::GnssSummary> gnssSummary(const graph::GnssReport& report,
                                                 const std::optional<GeodeticPosition>& origin) {
  if (report.fixes == 0) return std::nullopt;
  products::GnssSummary summary;
  summary.state = graph::gnssStateName(report.state);
  summary.distrusted = report.state == graph::GnssState::distrusted;
  summary.fixes = static_cast<std::uint64_t>(report.fixes);
  summary.unbelievable = static_cast<std::uint64_t>(report.unbelievable);
  summary.largestDeviation_m = report.largestDeviation_m;
  for (const auto& span : report.spans)
    summary.spans.push_back({span.from, span.to, static_cast<std::uint64_t>(span.fixes), span.largestDeviation_m});
  if (report.state == graph::GnssState::trusted && report.T_enu_map && origin)
    summary.mapOrigin = mapOrigin(*report.T_enu_map, *origin);
  return summary;
}

std::string gnssWarning(const products::GnssSummary& summary) {
  if (!summary.distrusted) return {};
  std::string text = mrpt::format("GNSS contradicts the map (%zu of %zu fixes, by up to %.1f m) and took no part in it",
                                  static_cast<std::size_t>(summary.unbelievable),
                                  static_cast<std::size_t>(summary.fixes), summary.largestDeviation_m);
  const char* separator = ": distrusted ";
  for (const auto& span : summary.spans) {
    text += separator + ("from " + core::formatUtc(span.from)) + " to " + core::formatUtc(span.to);
    separator = ", ";
  }
  return text;
}

}  // namespace s2s::mapper
