#pragma once

#include <cmath>

#include "s2s/core/time.h"
#include "s2s/core/transform.h"
#include "s2s/obs/CObservationLidarSweep.h"

namespace s2s::test {

/// A sweep of 32 beams x 256 columns from inside a box room 20 x 12 x 8 m whose floor is 2 m below the map's origin,
/// with a pillar of 0.5 m radius at (4, 3): enough to tell every pose apart.
inline obs::CObservationLidarSweep::Ptr sweepInRoom(const core::Isometry& T_map_vehicle,
                                                    const core::Isometry& T_vehicle_sensor) {
  auto sweep = obs::CObservationLidarSweep::Create();
  sweep->sensorLabel = "LIDAR";
  sweep->timestamp = core::toMrptTime(1'733'400'000'000'000'000);
  sweep->sensorPose = core::toPose(T_vehicle_sensor);
  sweep->rowCount = 32;
  sweep->columnCount = 256;
  sweep->rangeResolution_m = 0.001;
  for (int row = 0; row < 32; ++row)
    sweep->beamAltitude_rad.push_back(static_cast<float>((22.5 - 1.45 * row) * M_PI / 180));
  for (int column = 0; column < 256; ++column)
    sweep->columnAzimuth_rad.push_back(static_cast<float>(-2 * M_PI * column / 256));
  sweep->echoes.resize(1);
  const core::Isometry T = T_map_vehicle * T_vehicle_sensor;
  const Eigen::Vector3d o = T.translation();
  for (int row = 0; row < 32; ++row)
    for (int column = 0; column < 256; ++column) {
      const double alt = sweep->beamAltitude_rad[static_cast<std::size_t>(row)];
      const double az = sweep->columnAzimuth_rad[static_cast<std::size_t>(column)];
      const Eigen::Vector3d d =
          T.linear() * Eigen::Vector3d(std::cos(alt) * std::cos(az), std::cos(alt) * std::sin(az), std::sin(alt));
      double range = 1e9;
      const Eigen::Vector3d low(-10, -6, -2), high(10, 6, 6);
      for (int axis = 0; axis < 3; ++axis)
        if (d[axis] != 0) range = std::min(range, ((d[axis] > 0 ? high : low)[axis] - o[axis]) / d[axis]);
      // The pillar: a vertical cylinder.
      const Eigen::Vector2d dc = o.head<2>() - Eigen::Vector2d(4, 3), dd = d.head<2>();
      const double a = dd.squaredNorm(), b = dc.dot(dd), c = dc.squaredNorm() - 0.25;
      if (b * b - a * c > 0) {
        const double t = (-b - std::sqrt(b * b - a * c)) / a;
        if (t > 0) range = std::min(range, t);
      }
      sweep->echoes[0].range.push_back(static_cast<std::uint32_t>(std::lround(1000 * range)));
      sweep->echoes[0].reflectivity.push_back(static_cast<std::uint16_t>(100 + row));
    }
  return sweep;
}

}  // namespace s2s::test
