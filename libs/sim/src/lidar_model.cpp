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

/// Buffers of one column.
struct LidarModel::Column {
  std::vector<Ray> rays, raysBeside;
  std::vector<double> water_m;  // range at which the beam meets the water; infinite if it does not
  std::vector<RayHit> hits, hitsBeside;
  std::vector<LidarEcho> echoes;
};

LidarModel::LidarModel(const LidarOptions& options, const Isometry& T_vehicle_sensor, const Scene& scene,
                       const RayCaster& caster, std::uint64_t seed)
    : options_(options),
      T_vehicle_sensor_(T_vehicle_sensor),
      scene_(scene),
      caster_(caster),
      seed_(seed),
      prototype_(makePrototype(options)) {
  makeDirections();
  if (options.effects.ownVessel && !scene.vesselParts.empty()) findOwnVessel();
}

void LidarModel::makeDirections() {
  const Isometry T_sensor_lidar = core::toIsometry(prototype_.T_sensor_lidar);
  for (std::size_t column = 0; column < prototype_.columnCount; ++column) {
    const double azimuth = prototype_.columnAzimuth_rad[column];
    origins_.push_back(T_sensor_lidar *
                       Vector3d(kBeamOriginOffset_m * std::cos(azimuth), kBeamOriginOffset_m * std::sin(azimuth), 0));
    for (std::size_t row = 0; row < prototype_.rowCount; ++row) {
      const double altitude = prototype_.beamAltitude_rad[row], theta = azimuth + prototype_.beamAzimuth_rad[row];
      directions_.push_back(T_sensor_lidar.linear() * Vector3d(std::cos(altitude) * std::cos(theta),
                                                               std::cos(altitude) * std::sin(theta),
                                                               std::sin(altitude)));
    }
  }
}

void LidarModel::findOwnVessel() {
  const RayCaster vessel(scene_.vesselParts);
  ownVessel_.resize(prototype_.pixelCount());
  Column work;
  for (std::size_t column = 0; column < prototype_.columnCount; ++column) {
    makeRays(T_vehicle_sensor_, column, work);
    for (Ray& ray : work.rays) ray.maxRange_m = 20;
    vessel.cast(work.rays, work.hits);
    for (std::size_t row = 0; row < work.rays.size(); ++row)
      if (work.hits[row].hit())
        ownVessel_[column * prototype_.rowCount + row] = echoOf(
            work.hits[row], work.rays[row], scene_.materials[scene_.vesselParts[work.hits[row].object].material]);
  }
}

void LidarModel::makeRays(const Isometry& T_world_sensor, std::size_t column, Column& work) const {
  const Vector3d origin = T_world_sensor * origins_[column];
  work.rays.clear();
  work.water_m.clear();
  for (std::size_t row = 0; row < prototype_.rowCount; ++row) {
    const Vector3d direction = T_world_sensor.linear() * directions_[column * prototype_.rowCount + row];
    const double water_m =
        direction.z() < -1e-6 ? origin.z() / -direction.z() : std::numeric_limits<double>::infinity();
    const double reach_m = std::clamp(water_m, 0.0, options_.maxRange_m);  // nothing from below the water
    work.rays.push_back({origin.cast<float>(), direction.cast<float>(), static_cast<float>(reach_m)});
    work.water_m.push_back(water_m);
  }
}

void LidarModel::addWater(Random& random, Column& work) const {
  const LidarEffects& e = options_.effects;
  for (std::size_t row = 0; row < work.rays.size(); ++row) {
    if (work.echoes[row].present() || work.water_m[row] > options_.maxRange_m) continue;
    if (e.waterReturns) work.echoes[row] = waterReturn(work.rays[row], work.water_m[row], e, random);
    if (work.echoes[row].present() || !e.waterGhosts) continue;
    const MirroredRay mirrored = mirrorAtWater(work.rays[row], work.water_m[row], options_.maxRange_m);
    // Both ways go over the surface; below a thousandth nothing of it would be detected.
    const double power = e.waterSmoothness * mirrored.reflectance * mirrored.reflectance;
    if (power < 1e-3 || random.uniform() > e.waterSmoothness) continue;
    const RayHit hit = caster_.cast(mirrored.ray);
    if (!hit.hit()) continue;
    work.echoes[row] = echoOf(hit, mirrored.ray, scene_.materials[scene_.objects[hit.object].material]);
    work.echoes[row].brightness *= mirrored.reflectance * mirrored.reflectance;
    work.echoes[row].range_m += work.water_m[row];
  }
}

void LidarModel::mixAtEdges(Random& random, Column& work) const {
  work.raysBeside = work.rays;
  for (Ray& ray : work.raysBeside) ray.direction = directionBeside(ray.direction, options_.effects, random);
  caster_.cast(work.raysBeside, work.hitsBeside);
  for (std::size_t row = 0; row < work.echoes.size(); ++row) {
    const RayHit& hit = work.hitsBeside[row];
    if (!hit.hit()) continue;
    const Material& material = scene_.materials[scene_.objects[hit.object].material];
    mixPixel(work.echoes[row], echoOf(hit, work.raysBeside[row], material), options_.effects, random);
  }
}

void LidarModel::findEchoes(std::size_t column, Random& random, Column& work) const {
  caster_.cast(work.rays, work.hits);
  work.echoes.assign(work.rays.size(), {});
  for (std::size_t row = 0; row < work.rays.size(); ++row)
    if (work.hits[row].hit())
      work.echoes[row] =
          echoOf(work.hits[row], work.rays[row], scene_.materials[scene_.objects[work.hits[row].object].material]);
  if (options_.effects.mixedPixels) mixAtEdges(random, work);
  if (options_.effects.waterReturns || options_.effects.waterGhosts) addWater(random, work);
  if (!ownVessel_.empty())
    for (std::size_t row = 0; row < work.rays.size(); ++row) {
      const LidarEcho& own = ownVessel_[column * prototype_.rowCount + row];
      if (own.present() && (!work.echoes[row].present() || own.range_m < work.echoes[row].range_m))
        work.echoes[row] = own;
    }
}

obs::CObservationLidarSweep::Ptr LidarModel::sweep(const VesselMotion& motion, double t_s, core::TimeNs time,
                                                   std::uint32_t number) const {
  auto sweep = std::make_shared<obs::CObservationLidarSweep>(prototype_);
  sweep->timestamp = core::toMrptTime(time);
  sweep->frameId = number;
  Random random(seed_, 2, number);
  Column work;
  for (std::size_t column = 0; column < sweep->columnCount; ++column) {
    makeRays(motion.pose(t_s + 1e-9 * sweep->columnTime_ns[column]) * T_vehicle_sensor_, column, work);
    findEchoes(column, random, work);
    for (std::size_t row = 0; row < sweep->rowCount; ++row) {
      const LidarEcho& echo = work.echoes[row];
      const double range_m = detectedRange_m(echo, options_.effects, random);
      if (range_m < options_.minRange_m) continue;
      const std::size_t pixel = row * sweep->columnCount + column;
      sweep->echoes[0].range[pixel] =
          static_cast<std::uint32_t>(std::lround((range_m + kBeamOriginOffset_m) / sweep->rangeResolution_m));
      sweep->echoes[0].reflectivity[pixel] =
          static_cast<std::uint16_t>(std::lround(std::min(255.0, 100 * echo.brightness)));
    }
  }
  return sweep;
}

}  // namespace s2s::sim
