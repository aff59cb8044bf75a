#include "s2s/sim/sonar_geometry.h"

#include <cmath>

namespace s2s::sim {

using Eigen::Vector3d;

SonarOptions verticalSonarDefaults() {
  SonarOptions o;
  o.label = "SONAR_VERTICAL";
  o.model = "BlueView M900-2250-130-Mk2";
  o.T_vehicle_sensor = core::isometryFromXyzYpr(-1.13, -0.14, -0.58, 0, M_PI / 4, M_PI / 2);
  o.rate_hz = 10;
  o.startOffset_s = 0.029;
  o.beamCount = 256;
  o.fan_rad = 45 * M_PI / 180;
  o.spacing = BeamSpacing::UniformAngle;
  o.rangeCount = 800;
  o.frequency_hz = 2250e3;
  o.absorption_dbPerM = 1.6;
  o.tvgAbsorption_dbPerM = 2.4;
  o.noiseLevel_db = 72;
  o.artefacts.banding = false;
  o.artefacts.streaks = false;
  o.artefacts.centreHaze = true;
  o.pulseLength_m = 0.02;
  return o;
}

SonarGeometry::SonarGeometry(const SonarOptions& options) : options_(options) {
  const int n = options.beamCount;
  const double half = 0.5 * options.fan_rad;
  const auto bearingAt = [&](double position) {  // -1 .. 1 from the first to the last beam's centre
    if (options.spacing == BeamSpacing::UniformAngle) return half * position;
    return std::asin(std::clamp(std::sin(half) * position, -1.0, 1.0));
  };
  for (int i = 0; i < n; ++i) bearings_.push_back(bearingAt(-1 + 2.0 * i / (n - 1)));
  for (int i = 0; i <= n; ++i) edges_.push_back(bearingAt(-1 + 2.0 * (i - 0.5) / (n - 1)));
}

Vector3d SonarGeometry::direction(const Angle& b, const Angle& e) const {
  if (options_.bearingModel == obs::BearingModel::Azimuth) return {e.cosine * b.cosine, e.cosine * b.sine, e.sine};
  return {b.cosine * e.cosine, b.sine, b.cosine * e.sine};
}

double SonarGeometry::trueBearing_rad(double b) const {
  // Delays over the array are sin(bearing) / c: what is formed with one sound speed looks elsewhere at another.
  return std::asin(std::clamp(std::sin(b) * options_.soundSpeed_mps / options_.soundSpeedAssumed_mps, -1.0, 1.0));
}

double SonarGeometry::formedBearing_rad(double b) const {
  return std::asin(std::clamp(std::sin(b) * options_.soundSpeedAssumed_mps / options_.soundSpeed_mps, -1.0, 1.0));
}

Eigen::Vector2d SonarGeometry::bearingElevation(const Vector3d& d) const {
  if (options_.bearingModel == obs::BearingModel::Azimuth)
    return {std::atan2(d.y(), d.x()), std::asin(std::clamp(d.z(), -1.0, 1.0))};
  return {std::asin(std::clamp(d.y(), -1.0, 1.0)), std::atan2(d.z(), d.x())};
}

double SonarGeometry::beamPosition(double bearing_rad) const {
  const double half = 0.5 * options_.fan_rad;
  const double u =
      options_.spacing == BeamSpacing::UniformAngle ? bearing_rad / half : std::sin(bearing_rad) / std::sin(half);
  return 0.5 * (u + 1) * (options_.beamCount - 1);
}

}  // namespace s2s::sim
