#include "observation_points.h"

#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <cmath>

#include "s2s/core/transform.h"
#include "s2s/obs/CObservationLidarSweep.h"
#include "s2s/obs/sweep_projector.h"

namespace s2s::map {

namespace {

using Points = std::vector<ScanPoint>;

float lidarSigma(float distance_m, const InsertionOptions& options) {
  return static_cast<float>(std::hypot(options.lidarRangeSigma_m, distance_m * options.lidarAngleSigma_rad));
}

Points pointsOfSweep(const obs::CObservationLidarSweep& sweep, const InsertionOptions& options) {
  Points points;
  if (sweep.echoes.empty()) return points;
  obs::SweepProjector projector;
  projector.prepare(sweep);
  const Eigen::Isometry3f T_vehicle_sensor = core::toIsometry(sweep.sensorPose).cast<float>();
  const auto& echo = sweep.echoes.front();
  points.reserve(sweep.returnCount());
  for (std::size_t row = 0; row < sweep.rowCount; ++row)
    for (std::size_t column = 0; column < sweep.columnCount; ++column) {
      const std::size_t pixel = row * sweep.columnCount + column;
      if (echo.range[pixel] == 0 || !sweep.isColumnValid(column)) continue;
      const Eigen::Vector3f p_sensor = projector.point(row, column, echo.range[pixel]);
      const auto intensity = !echo.reflectivity.empty() ? echo.reflectivity[pixel]
                             : !echo.signal.empty()     ? echo.signal[pixel]
                                                        : std::uint16_t{0};
      points.push_back(
          {T_vehicle_sensor * p_sensor, static_cast<float>(intensity), lidarSigma(p_sensor.norm(), options)});
    }
  return points;
}

/// Points of an MRPT map whose coordinates are in the vehicle's frame already.
Points pointsOfMap(const mrpt::maps::CPointsMap& map, const core::Isometry& T_vehicle_map,
                   const InsertionOptions& options) {
  const auto* withIntensity = dynamic_cast<const mrpt::maps::CPointsMapXYZI*>(&map);
  const Eigen::Isometry3f T = T_vehicle_map.cast<float>();
  const auto &xs = map.getPointsBufferRef_x(), &ys = map.getPointsBufferRef_y(), &zs = map.getPointsBufferRef_z();
  Points points(xs.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3f p(xs[i], ys[i], zs[i]);
    points[i] = {T * p, withIntensity ? withIntensity->getPointIntensity_fast(i) : 0.0f, lidarSigma(p.norm(), options)};
  }
  return points;
}

/// Through MRPT's own conversion, which knows range scans of all kinds.
std::optional<Points> pointsByMrpt(const mrpt::obs::CObservation& observation, const InsertionOptions& options) {
  mrpt::maps::CSimplePointsMap map;
  map.insertionOptions.minDistBetweenLaserPoints = 0;
  map.insertionOptions.also_interpolate = false;
  if (!map.insertObservation(observation)) return std::nullopt;
  return pointsOfMap(map, core::Isometry::Identity(), options);
}

}  // namespace

bool carriesPoints(const mrpt::obs::CObservation& observation) {
  return dynamic_cast<const obs::CObservationLidarSweep*>(&observation) ||
         dynamic_cast<const mrpt::obs::CObservationPointCloud*>(&observation) ||
         dynamic_cast<const mrpt::obs::CObservation2DRangeScan*>(&observation) ||
         dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(&observation) ||
         dynamic_cast<const mrpt::obs::CObservationVelodyneScan*>(&observation);
}

std::optional<Points> pointsOf(const mrpt::obs::CObservation& observation, const InsertionOptions& options) {
  if (!carriesPoints(observation)) return std::nullopt;
  observation.load();  // clouds may lie in a file of their own
  if (const auto* sweep = dynamic_cast<const obs::CObservationLidarSweep*>(&observation))
    return pointsOfSweep(*sweep, options);
  if (const auto* cloud = dynamic_cast<const mrpt::obs::CObservationPointCloud*>(&observation)) {
    if (!cloud->pointcloud) return std::nullopt;
    return pointsOfMap(*cloud->pointcloud, core::toIsometry(cloud->sensorPose), options);
  }
  return pointsByMrpt(observation, options);
}

}  // namespace s2s::map
