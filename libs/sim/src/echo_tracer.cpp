#include <cmath>

#include "s2s/sim/beam_pattern.h"
#include "s2s/sim/sonar_echo.h"

namespace s2s::sim {

using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {

constexpr double kMaxElevation_rad = 80 * M_PI / 180;

/// Half the elevation over which rays are cast.
double halfExtent_rad(const SonarOptions& o) {
  if (o.elevationPattern == ElevationPattern::Rectangle) return 0.5 * o.aperture_rad;
  return std::min(kMaxElevation_rad, 1.6 * o.aperture_rad);  // main lobe and first side lobes
}

/// Two-way power pattern across the imaging plane, one on it; at +-aperture/2 each way has lost 3 dB.
double elevationGain(const SonarOptions& o, double elevation_rad) {
  if (o.elevationPattern == ElevationPattern::Rectangle) return 1;
  const double x = halfPowerPoint(1) * std::sin(elevation_rad) / std::sin(0.5 * o.aperture_rad);
  const double oneWay = arrayPattern(x, 1);
  return oneWay * oneWay * oneWay * oneWay;
}

}  // namespace

struct EchoTracer::Sample {
  double gain = 0;        // two-way pattern times solid angle
  Vector3f lower, upper;  // directions of the sample's edges in elevation, world frame
};

EchoTracer::EchoTracer(const SonarOptions& options, const SonarGeometry& geometry, const Scene& scene,
                       const RayCaster& caster)
    : options_(options), geometry_(geometry), scene_(scene), caster_(caster) {
  elevationMin_rad_ = -halfExtent_rad(options);
  elevationStep_rad_ = 2 * halfExtent_rad(options) / options.elevationRays;
}

void EchoTracer::makeRays(const core::Isometry& T_world_sensor, std::size_t beam, Random& random,
                          std::vector<Ray>& rays, std::vector<Sample>& samples) const {
  const Vector3f origin = T_world_sensor.translation().cast<float>();
  const Eigen::Matrix3d& R = T_world_sensor.linear();
  const double c = options_.soundSpeed_mps / options_.soundSpeedAssumed_mps;
  const double maxRange_m = options_.maxRange_m * c + 2 * options_.pulseLength_m;
  const double bearing = geometry_.bearingInCell_rad(beam, random.uniform());
  const auto edgeDirection = [&](int i) -> Vector3f {
    return (R * geometry_.direction(bearing, elevationMin_rad_ + i * elevationStep_rad_)).cast<float>();
  };
  Vector3f lower = edgeDirection(0);
  for (int i = 0; i < options_.elevationRays; ++i) {
    const double elevation = elevationMin_rad_ + (i + random.uniform()) * elevationStep_rad_;
    const Vector3d d = R * geometry_.direction(bearing, elevation);
    const Vector3f upper = edgeDirection(i + 1);
    // Solid angle: the azimuth half-planes narrow with cos(elevation), the cones with cos(bearing).
    const double narrowing =
        options_.bearingModel == obs::BearingModel::Azimuth ? std::cos(elevation) : std::cos(bearing);
    const double solidAngle = geometry_.cellWidth_rad(beam) * elevationStep_rad_ * narrowing;
    double reach = maxRange_m;
    if (d.z() > 1e-6) reach = std::min(reach, -T_world_sensor.translation().z() / d.z());  // ends at the surface
    rays.push_back({origin, d.cast<float>(), static_cast<float>(std::max(0.0, reach))});
    samples.push_back({elevationGain(options_, elevation) * solidAngle, lower, upper});
    lower = upper;
  }
}

double EchoTracer::patchPower(double range_m, double cosIncidence, const Material& material) const {
  // Echo level = SL - 2 TL + S_b + 10 log A (Urick 1983, ch. 2 and 8) with Lambert's S_b = mu cos^2(incidence) and
  // A = r^2 dOmega / cos(incidence); the caller multiplies by dOmega and the beam pattern.
  double level_db = options_.sourceLevel_db + material.backscatter_db;
  if (options_.absorption) level_db -= 2 * options_.absorption_dbPerM * range_m;
  const double spreading = options_.spreading ? 1 / (range_m * range_m * range_m * range_m) : 1;
  return std::pow(10, 0.1 * level_db) * spreading * range_m * range_m * cosIncidence;
}

void EchoTracer::deposit(const Sample& sample, const Ray& ray, const RayHit& hit, double power,
                         EchoImage& image) const {
  const double scale = options_.soundSpeedAssumed_mps / options_.soundSpeed_mps;  // true to recorded range
  const double resolution_m = options_.maxRange_m / options_.rangeCount;
  // Where the patch's plane cuts the edges of the sample; a plane seen edge-on is cut off at a few sample widths.
  const float toPlane = hit.range_m * hit.normal.dot(ray.direction);
  const double limit = 8 * hit.range_m * elevationStep_rad_;
  const auto cut = [&](const Vector3f& edge) -> double {
    const float along = hit.normal.dot(edge);
    if (along > -1e-4f) return hit.range_m + limit;
    return std::clamp<double>(toPlane / along, hit.range_m - limit, hit.range_m + limit);
  };
  double near = cut(sample.lower), far = cut(sample.upper);
  if (near > far) std::swap(near, far);
  const double first = std::max(near, 0.0) * scale / resolution_m, last = far * scale / resolution_m;
  const double perBin = power / std::max(last - first, 1e-9);
  const auto begin = static_cast<std::int64_t>(first), end = static_cast<std::int64_t>(last);
  for (std::int64_t bin = begin; bin <= end && bin < options_.rangeCount; ++bin) {
    const double share =
        std::min<double>(last, static_cast<double>(bin + 1)) - std::max<double>(first, static_cast<double>(bin));
    const double amount = last - first < 1e-6 ? power : perBin * share;
    image.power[static_cast<std::size_t>(bin) * image.beamCount] += static_cast<float>(amount);
  }
}

void EchoTracer::trace(const core::Isometry& T_world_sensor, Random& random, EchoImage& image,
                       std::vector<EchoPatch>* patches) const {
  image.reset(static_cast<std::size_t>(options_.rangeCount), geometry_.bearings_rad().size());
  EchoImage column;  // one beam at a time: its bins lie together
  std::vector<Ray> rays;
  std::vector<Sample> samples;
  std::vector<RayHit> hits;
  for (std::size_t beam = 0; beam < image.beamCount; ++beam) {
    rays.clear();
    samples.clear();
    makeRays(T_world_sensor, beam, random, rays, samples);
    caster_.cast(rays, hits);
    column.reset(image.rangeCount, 1);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (!hits[i].hit()) continue;
      const Material& material = scene_.materials[scene_.objects[hits[i].object].material];
      const double cosIncidence = -hits[i].normal.dot(rays[i].direction);
      const double power = samples[i].gain * patchPower(hits[i].range_m, cosIncidence, material);
      deposit(samples[i], rays[i], hits[i], power, column);
      if (patches)
        patches->push_back({static_cast<std::uint32_t>(beam), hits[i].range_m, static_cast<float>(power),
                            hits[i].object, rays[i].origin + hits[i].range_m * rays[i].direction});
    }
    for (std::size_t bin = 0; bin < image.rangeCount; ++bin) image.at(bin, beam) = column.power[bin];
  }
}

}  // namespace s2s::sim
