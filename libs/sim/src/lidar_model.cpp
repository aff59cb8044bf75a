#include "s2s/sim/lidar_model.h"

#include <cmath>
#include <cstdio>

#include "s2s/core/error.h"

namespace s2s::sim {

using core::Isometry;
using Eigen::Vector3d;

namespace {

// Geometry of an Ouster OS1 (its hardware manual): beams start on a circle, rows are staggered in azimuth, and the
// LiDAR's frame is turned by half a revolution and raised against the sensor's.
constexpr double kBeamOriginOffset_m = 0.015806;
constexpr double kLidarHeight_m = 0.036180;
constexpr double kStagger_rad[4] = {4.2 * M_PI / 180, 1.4 * M_PI / 180, -1.4 * M_PI / 180, -4.2 * M_PI / 180};

obs::CObservationLidarSweep makePrototype(const LidarOptions& o) {
  obs::CObservationLidarSweep s;
  s.sensorLabel = o.label;
  s.sensorModel = "simulated OS1-" + std::to_string(o.rows);
  s.sensorPose = core::toPose(o.T_vehicle_sensor);
  s.rowCount = static_cast<std::uint32_t>(o.rows);
  s.columnCount = static_cast<std::uint32_t>(o.columns);
  s.minRange_m = o.minRange_m;
  s.maxRange_m = o.maxRange_m;
  s.beamOriginOffset_m = kBeamOriginOffset_m;
  s.T_sensor_lidar = core::toPose(core::isometryFromXyzYpr(0, 0, kLidarHeight_m, M_PI, 0, 0));
  for (int row = 0; row < o.rows; ++row) {
    const double position = o.rows > 1 ? 0.5 - static_cast<double>(row) / (o.rows - 1) : 0;
    s.beamAltitude_rad.push_back(static_cast<float>(position * o.verticalFov_rad));
    s.beamAzimuth_rad.push_back(static_cast<float>(kStagger_rad[row % 4]));
  }
  const double columnPeriod_ns = 1e9 / (o.rate_hz * o.columns);
  for (int column = 0; column < o.columns; ++column) {
    s.columnAzimuth_rad.push_back(static_cast<float>(2 * M_PI * (1 - static_cast<double>(column) / o.columns)));
    s.columnTime_ns.push_back(static_cast<std::int32_t>(std::lround(column * columnPeriod_ns)));
  }
  s.echoes.resize(1);
  s.echoes[0].range.assign(s.pixelCount(), 0);
  s.echoes[0].reflectivity.assign(s.pixelCount(), 0);
  return s;
}

}  // namespace

void parseLidarMode(const std::string& text, LidarOptions& o) {
  int rows = 0, columns = 0, used = 0;
  double rate = 0;
  if (std::sscanf(text.c_str(), "%dx%d@%lf%n", &rows, &columns, &rate, &used) != 3 ||
      static_cast<std::size_t>(used) != text.size() || rows < 1 || rows > 1024 || columns < 8 || columns > 8192 ||
      rate <= 0 || rate > 100)
    throw core::ConfigError("'" + text + "' is no LiDAR mode", "--lidar",
                            "write rows x columns @ rate, e.g. 64x1024@10");
  o.rows = rows;
  o.columns = columns;
  o.rate_hz = rate;
}

LidarModel::LidarModel(const LidarOptions& options, const Isometry& T_vehicle_sensor, const Scene& scene,
                       const RayCaster& caster, std::uint64_t seed)
    : options_(options),
      T_vehicle_sensor_(T_vehicle_sensor),
      scene_(scene),
      caster_(caster),
      seed_(seed),
      prototype_(makePrototype(options)) {}

void LidarModel::castColumn(const Isometry& T_world_sensor, const obs::CObservationLidarSweep& sweep,
                            std::size_t column, std::vector<Ray>& rays) const {
  const Isometry T_world_lidar = T_world_sensor * core::toIsometry(sweep.T_sensor_lidar);
  const double azimuth = sweep.columnAzimuth_rad[column];
  const Vector3d origin =
      T_world_lidar * Vector3d(kBeamOriginOffset_m * std::cos(azimuth), kBeamOriginOffset_m * std::sin(azimuth), 0);
  for (std::size_t row = 0; row < sweep.rowCount; ++row) {
    const double altitude = sweep.beamAltitude_rad[row], theta = azimuth + sweep.beamAzimuth_rad[row];
    const Vector3d direction =
        T_world_lidar.linear() *
        Vector3d(std::cos(altitude) * std::cos(theta), std::cos(altitude) * std::sin(theta), std::sin(altitude));
    double reach = options_.maxRange_m;
    if (direction.z() < -1e-6) reach = std::min(reach, origin.z() / -direction.z());  // nothing from below the water
    rays.push_back({origin.cast<float>(), direction.cast<float>(), static_cast<float>(std::max(0.0, reach))});
  }
}

void LidarModel::record(const std::vector<Ray>& rays, const std::vector<RayHit>& hits, std::size_t column,
                        Random& random, obs::CObservationLidarSweep& sweep) const {
  for (std::size_t row = 0; row < rays.size(); ++row) {
    const RayHit& hit = hits[row];
    if (!hit.hit() || hit.range_m < options_.minRange_m) continue;
    const Material& material = scene_.materials[scene_.objects[hit.object].material];
    const double cosIncidence = -hit.normal.dot(rays[row].direction);
    const double brightness = material.retro ? 10 : material.reflectivity * cosIncidence;
    double range_m = hit.range_m;
    if (options_.noise) {
      // Half the white surfaces are lost at the nominal range; the signal falls with its square.
      const double signal = brightness * std::pow(options_.dropoutReflectivityRange_m / range_m, 2);
      if (random.uniform() > 1 - std::pow(0.5, signal)) continue;
      range_m += (options_.rangeSigma_m + options_.rangeSigmaFar_mPerM * range_m) * random.normal();
    }
    const std::size_t pixel = row * sweep.columnCount + column;
    sweep.echoes[0].range[pixel] =
        static_cast<std::uint32_t>(std::lround((range_m + kBeamOriginOffset_m) / sweep.rangeResolution_m));
    sweep.echoes[0].reflectivity[pixel] = static_cast<std::uint16_t>(std::lround(std::min(255.0, 100 * brightness)));
  }
}

obs::CObservationLidarSweep::Ptr LidarModel::sweep(const VesselMotion& motion, double t_s, core::TimeNs time,
                                                   std::uint32_t number) const {
  auto sweep = std::make_shared<obs::CObservationLidarSweep>(prototype_);
  sweep->timestamp = core::toMrptTime(time);
  sweep->frameId = number;
  Random random(seed_, 2, number);
  std::vector<Ray> rays;
  std::vector<RayHit> hits;
  for (std::size_t column = 0; column < sweep->columnCount; ++column) {
    rays.clear();
    castColumn(motion.pose(t_s + 1e-9 * sweep->columnTime_ns[column]) * T_vehicle_sensor_, *sweep, column, rays);
    caster_.cast(rays, hits);
    record(rays, hits, column, random, *sweep);
  }
  return sweep;
}

}  // namespace s2s::sim
