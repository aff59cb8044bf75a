#pragma once

#include <algorithm>
#include <random>
#include <vector>

#include "s2s/core/transform.h"
#include "s2s/obs/CObservationImagingSonar.h"
#include "s2s/sonar/ping_geometry.h"

namespace s2s::sonar::test {

constexpr double kDeg = M_PI / 180.0;

/// A ping of zeros: 130 degrees, or as told, uniform in bearing.
inline obs::CObservationImagingSonar emptyPing(std::uint32_t beams = 512, std::uint32_t bins = 700,
                                               double fan_rad = 130 * kDeg, std::uint8_t bytes = 1) {
  obs::CObservationImagingSonar ping;
  ping.sensorLabel = "SONAR";
  ping.beamCount = beams;
  ping.rangeCount = bins;
  ping.bytesPerSample = bytes;
  ping.samples.assign(static_cast<std::size_t>(beams) * bins * bytes, 0);
  for (std::uint32_t i = 0; i < beams; ++i)
    ping.bearings_rad.push_back(static_cast<float>(fan_rad * ((i + 0.5) / static_cast<double>(beams) - 0.5)));
  ping.rangeResolution_m = 10.0 / bins;
  ping.verticalAperture_rad = 20 * kDeg;
  return ping;
}

inline void setSample(obs::CObservationImagingSonar& ping, std::size_t bin, std::size_t beam, std::uint32_t value) {
  std::uint8_t* bytes = ping.samples.data() + (bin * ping.beamCount + beam) * ping.bytesPerSample;
  for (std::size_t i = 0; i < ping.bytesPerSample; ++i) bytes[i] = static_cast<std::uint8_t>(value >> (8 * i));
}

/// Fills a ping with what point scatterers in view send back: powers add up in each pixel, times speckle (an
/// exponential factor of mean 1), plus weak noise; the grey level is the root of the power.
inline void renderPoints(obs::CObservationImagingSonar& ping, const std::vector<Eigen::Vector3d>& points_sonar,
                         unsigned seed) {
  const PingGeometry geometry = geometryOf(ping);
  std::vector<double> power(static_cast<std::size_t>(ping.beamCount) * ping.rangeCount, 0);
  for (const auto& p : points_sonar) {
    const auto c = sonarCoordinates(p, geometry.bearingModel);
    if (std::abs(c.elevation_rad) > 0.5 * geometry.verticalAperture_rad) continue;
    const double beam = geometry.beamAt(c.bearing_rad), bin = geometry.binAt(c.range_m);
    if (beam < 0 || bin < 0 || bin > ping.rangeCount - 1.0) continue;
    power[static_cast<std::size_t>(std::lround(bin)) * ping.beamCount + static_cast<std::size_t>(std::lround(beam))] +=
        1;
  }
  double mean = 0;
  std::size_t lit = 0;
  for (const double value : power) {
    mean += value;
    lit += value > 0 ? 1 : 0;
  }
  mean /= static_cast<double>(std::max<std::size_t>(1, lit));
  std::mt19937 random(seed);
  std::exponential_distribution<double> speckle(1.0);
  for (std::size_t i = 0; i < power.size(); ++i) {
    const double amplitude = 110 * std::sqrt(power[i] / mean * speckle(random)) + 8 * std::sqrt(speckle(random));
    setSample(ping, i / ping.beamCount, i % ping.beamCount, static_cast<std::uint32_t>(std::min(255.0, amplitude)));
  }
}

/// The same ping with its beams stored from the other side, as an Oculus stores them: bearings fall from beam to beam.
inline obs::CObservationImagingSonar fromOtherSide(obs::CObservationImagingSonar ping) {
  const auto stored = ping.samples;
  const std::size_t beams = ping.beamCount, bytes = ping.bytesPerSample;
  for (std::size_t row = 0; row < ping.rangeCount; ++row)
    for (std::size_t beam = 0; beam < beams; ++beam)
      std::copy_n(stored.data() + (row * beams + beam) * bytes, bytes,
                  ping.samples.data() + (row * beams + beams - 1 - beam) * bytes);
  std::reverse(ping.bearings_rad.begin(), ping.bearings_rad.end());
  return ping;
}

/// A level seabed `depth_m` below the origin of frame "level" (x ahead, z up), every centimetre.
inline std::vector<Eigen::Vector3d> levelSeabed(double depth_m) {
  std::vector<Eigen::Vector3d> points;
  for (double x = 0.5; x < 9; x += 0.01)
    for (double y = -2.5; y < 2.5; y += 0.01) points.emplace_back(x, y, -depth_m);
  return points;
}

inline std::vector<Eigen::Vector3d> transformed(const core::Isometry& T, std::vector<Eigen::Vector3d> points) {
  for (auto& p : points) p = T * p;
  return points;
}

/// Both sonars of a vessel: pitched 45 degrees down, the vertical one rolled by 90 degrees, beside and below the other.
struct TwinSonars {
  core::Isometry T_level_h = core::isometryFromXyzYpr(0, 0, 0, 0, 45 * kDeg, 0);
  core::Isometry T_level_v = core::isometryFromXyzYpr(-0.03, -0.14, -0.13, 0, 45 * kDeg, 90 * kDeg);
  core::Isometry T_h_v() const { return T_level_h.inverse() * T_level_v; }

  obs::CObservationImagingSonar horizontalPing(const std::vector<Eigen::Vector3d>& points_level) const {
    auto ping = emptyPing();
    renderPoints(ping, transformed(T_level_h.inverse(), points_level), 1);
    return ping;
  }
  obs::CObservationImagingSonar verticalPing(const std::vector<Eigen::Vector3d>& points_level) const {
    auto ping = emptyPing(256, 700, 45 * kDeg);
    renderPoints(ping, transformed(T_level_v.inverse(), points_level), 2);
    return ping;
  }
};

}  // namespace s2s::sonar::test
