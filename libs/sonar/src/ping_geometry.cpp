#include "s2s/sonar/ping_geometry.h"

#include <algorithm>
#include <cmath>

namespace s2s::sonar {

double PingGeometry::beamAt(double bearing_rad) const {
  if (bearings_rad.size() < 2) return !bearings_rad.empty() && bearings_rad.front() == bearing_rad ? 0 : -1;
  const bool rising = bearings_rad.front() < bearings_rad.back();
  // First beam not before the bearing in the order of the table.
  const auto after =
      std::lower_bound(bearings_rad.begin(), bearings_rad.end(), bearing_rad,
                       [rising](double beam, double value) { return rising ? beam < value : beam > value; });
  if (after == bearings_rad.end()) return -1;
  if (after == bearings_rad.begin()) return *after == bearing_rad ? 0 : -1;
  const double before = *(after - 1);
  return static_cast<double>(after - 1 - bearings_rad.begin()) + (bearing_rad - before) / (*after - before);
}

double PingGeometry::minBearing_rad() const {
  return bearings_rad.empty() ? 0 : std::min(bearings_rad.front(), bearings_rad.back());
}

double PingGeometry::maxBearing_rad() const {
  return bearings_rad.empty() ? 0 : std::max(bearings_rad.front(), bearings_rad.back());
}

PingGeometry geometryOf(const obs::CObservationImagingSonar& ping) {
  PingGeometry geometry;
  geometry.bearings_rad.assign(ping.bearings_rad.begin(), ping.bearings_rad.end());
  geometry.rangeOffset_m = ping.rangeOffset_m;
  geometry.rangeResolution_m = ping.rangeResolution_m;
  geometry.rangeCount = ping.rangeCount;
  geometry.verticalAperture_rad = ping.verticalAperture_rad;
  geometry.bearingModel = ping.bearingModel;
  return geometry;
}

SonarCoordinates sonarCoordinates(const Eigen::Vector3d& p_sonar, obs::BearingModel model) {
  SonarCoordinates coordinates;
  coordinates.range_m = p_sonar.norm();
  if (coordinates.range_m <= 0) return coordinates;
  coordinates.bearing_rad = model == obs::BearingModel::Azimuth
                                ? std::atan2(p_sonar.y(), p_sonar.x())
                                : std::asin(std::clamp(p_sonar.y() / coordinates.range_m, -1.0, 1.0));
  coordinates.elevation_rad = std::asin(std::clamp(p_sonar.z() / coordinates.range_m, -1.0, 1.0));
  return coordinates;
}

Eigen::Vector3d pointAt(const SonarCoordinates& coordinates, obs::BearingModel model) {
  const double sinBearing = std::sin(coordinates.bearing_rad), cosBearing = std::cos(coordinates.bearing_rad);
  const double sinElevation = std::sin(coordinates.elevation_rad), cosElevation = std::cos(coordinates.elevation_rad);
  if (model == obs::BearingModel::Azimuth)
    return coordinates.range_m * Eigen::Vector3d(cosElevation * cosBearing, cosElevation * sinBearing, sinElevation);
  const double z = std::clamp(sinElevation, -std::abs(cosBearing), std::abs(cosBearing));
  const double x = std::sqrt(std::max(0.0, cosBearing * cosBearing - z * z));
  return coordinates.range_m * Eigen::Vector3d(x, sinBearing, z);
}

}  // namespace s2s::sonar
