#include <cmath>

#include "s2s/sim/elevation_pattern.h"
#include "s2s/sim/sonar_echo.h"

namespace s2s::sim {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// Rays of one beam and what they met.
struct EchoTracer::Beam {
  double bearing_rad = 0;  // true bearing of this ping's rays in the beam's cell
  std::vector<Ray> rays;
  std::vector<RayHit> hits;
  std::vector<double> elevations_rad;
  std::vector<double> solidAngles;  // sr
  std::vector<Vector3f> edges;      // directions of the samples' edges, world frame; one more than rays
  std::vector<double> powers;       // direct echo of each ray
  std::vector<float> column;        // the beam's range bins
};

EchoTracer::EchoTracer(const SonarOptions& options, const SonarGeometry& geometry, const Scene& scene,
                       const RayCaster& caster)
    : options_(options),
      geometry_(geometry),
      scene_(scene),
      caster_(caster),
      multipath_(options, geometry),
      noisePower_(std::pow(10, 0.1 * options.noiseLevel_db)),
      edges_rad_(elevationEdges(options)) {
  for (std::size_t i = 0; i + 1 < edges_rad_.size(); ++i) {
    const double pattern = elevationPattern(options, 0.5 * (edges_rad_[i] + edges_rad_[i + 1]));
    gains_.push_back(pattern * pattern);
  }
  for (const double edge : edges_rad_) edgeAngles_.emplace_back(edge);
}

double EchoTracer::recordedBin(double range_m) const {
  const double believed_m = range_m * options_.soundSpeedAssumed_mps / options_.soundSpeed_mps;
  return believed_m * options_.rangeCount / options_.maxRange_m;
}

void EchoTracer::makeRays(const core::Isometry& T_world_sensor, std::size_t beam, Random& random, Beam& work) const {
  const Vector3f origin = T_world_sensor.translation().cast<float>();
  const Eigen::Matrix3d& R = T_world_sensor.linear();
  const double maxRange_m =
      options_.maxRange_m * options_.soundSpeed_mps / options_.soundSpeedAssumed_mps + 2 * options_.pulseLength_m;
  work.bearing_rad = geometry_.trueBearing_rad(geometry_.bearingInCell_rad(beam, random.uniform()));
  const Angle bearing(work.bearing_rad);
  const std::size_t n = edges_rad_.size() - 1;
  work.rays.resize(n);
  work.elevations_rad.resize(n);
  work.solidAngles.resize(n);
  work.edges.resize(n + 1);
  for (std::size_t i = 0; i <= n; ++i) work.edges[i] = (R * geometry_.direction(bearing, edgeAngles_[i])).cast<float>();
  for (std::size_t i = 0; i < n; ++i) {
    const double step = edges_rad_[i + 1] - edges_rad_[i];
    const double elevation = edges_rad_[i] + random.uniform() * step;
    const Angle angle(elevation);
    const Vector3d d = R * geometry_.direction(bearing, angle);
    // Solid angle: the azimuth half-planes narrow with cos(elevation), the cones with cos(bearing).
    const double narrowing =
        options_.bearingModel == obs::BearingModel::Azimuth ? std::cos(elevation) : std::cos(work.bearing_rad);
    double reach_m = maxRange_m;
    if (d.z() > 1e-6) reach_m = std::min(reach_m, -T_world_sensor.translation().z() / d.z());  // up to the surface
    work.rays[i] = {origin, d.cast<float>(), static_cast<float>(std::max(0.0, reach_m))};
    work.elevations_rad[i] = elevation;
    work.solidAngles[i] = geometry_.cellWidth_rad(beam) * step * narrowing;
  }
}

double EchoTracer::patchPower(double range_m, double cosIncidence, const Material& material,
                              const Vector3f& p_world) const {
  // Echo level = SL - 2 TL + S_b + 10 log A (Urick 1983, ch. 2 and 8) with Lambert's S_b = mu cos^2(incidence) and
  // A = r^2 dOmega / cos(incidence); the caller multiplies by dOmega and the beam pattern.
  double level_db = options_.sourceLevel_db + material.backscatter_db;
  if (options_.absorption) level_db -= 2 * options_.absorption_dbPerM * range_m;
  if (options_.texture) {
    const double u = 1 / options_.textureLength_m;  // the third coordinate shears into the other two
    level_db += options_.texture_db * fractalNoise(0x74657874, u * (p_world.x() + 0.7 * p_world.z()),
                                                   u * (p_world.y() - 0.6 * p_world.z()), 2);
  }
  const double spreading = options_.spreading ? 1 / (range_m * range_m * range_m * range_m) : 1;
  return std::pow(10, 0.1 * level_db) * spreading * range_m * range_m * cosIncidence;
}

void EchoTracer::deposit(const Beam& work, std::size_t ray, double power, std::vector<float>& column) const {
  const RayHit& hit = work.hits[ray];
  // Where the patch's plane cuts the edges of the sample; a plane seen edge-on is cut off at a few sample widths.
  const float toPlane = hit.range_m * hit.normal.dot(work.rays[ray].direction);
  const double limit = 8 * hit.range_m * (edges_rad_[ray + 1] - edges_rad_[ray]);
  const auto cut = [&](const Vector3f& edge) -> double {
    const float along = hit.normal.dot(edge);
    if (along > -1e-4f) return hit.range_m + limit;
    return std::clamp<double>(toPlane / along, hit.range_m - limit, hit.range_m + limit);
  };
  double near_m = cut(work.edges[ray]), far_m = cut(work.edges[ray + 1]);
  if (near_m > far_m) std::swap(near_m, far_m);
  const double first = std::max(0.0, recordedBin(near_m)), last = recordedBin(far_m);
  const double length = std::max(last - first, 1e-6);
  for (auto bin = static_cast<std::int64_t>(first); bin <= static_cast<std::int64_t>(last); ++bin) {
    if (bin >= static_cast<std::int64_t>(column.size())) break;
    const auto begin = static_cast<double>(bin);
    const double share = (std::min(first + length, begin + 1) - std::max(first, begin)) / length;
    column[static_cast<std::size_t>(bin)] += static_cast<float>(power * std::max(0.0, share));
  }
}

void EchoTracer::addGhosts(const core::Isometry& T_world_sensor, const Beam& work, std::size_t ray, double power,
                           EchoImage& image) const {
  if (options_.noise && power < 0.1 * noisePower_) return;  // its ghosts would drown
  GhostEcho ghosts[3];
  const Vector3f p_world = work.rays[ray].origin + work.hits[ray].range_m * work.rays[ray].direction;
  multipath_.find(T_world_sensor, p_world.cast<double>(), {work.bearing_rad, work.elevations_rad[ray]}, ghosts);
  for (const GhostEcho& g : ghosts) {
    const double bin = recordedBin(g.range_m);
    const double beam = std::round(geometry_.beamPosition(geometry_.formedBearing_rad(g.bearing_rad)));
    if (g.gain <= 0 || bin >= options_.rangeCount || beam < 0 || beam >= options_.beamCount) continue;
    image.at(static_cast<std::size_t>(bin), static_cast<std::size_t>(beam)) += static_cast<float>(power * g.gain);
  }
}

void EchoTracer::addVolume(EchoImage& image) const {
  // Volume reverberation (Urick 1983, eq. 8.7): S_v times the volume of the cell, r^2 dOmega dr.
  const double perCubicMetre = std::pow(10, 0.1 * (options_.sourceLevel_db + options_.volumeBackscatter_db));
  const double resolution_m = options_.maxRange_m / options_.rangeCount;
  for (std::size_t bin = 0; bin < image.rangeCount; ++bin) {
    const double r = (static_cast<double>(bin) + 0.5) * resolution_m;
    double density = perCubicMetre * options_.aperture_rad * resolution_m * r * r;
    if (options_.spreading) density /= r * r * r * r;
    if (options_.absorption) density *= std::pow(10, -0.2 * options_.absorption_dbPerM * r);
    for (std::size_t beam = 0; beam < image.beamCount; ++beam)
      image.at(bin, beam) += static_cast<float>(density * geometry_.cellWidth_rad(beam));
  }
}

void EchoTracer::findStrongest(const Beam& work, std::size_t beam, std::vector<StrongReturn>& strongest) const {
  const auto peak = std::max_element(work.column.begin(), work.column.end());
  const double power_db = 10 * std::log10(std::max(*peak, 1e-30f));
  if (options_.noise && power_db < options_.noiseLevel_db) return;
  const auto bin = static_cast<std::int64_t>(peak - work.column.begin());
  std::size_t best = work.rays.size();
  for (std::size_t i = 0; i < work.rays.size(); ++i) {
    if (!work.hits[i].hit() || std::abs(recordedBin(work.hits[i].range_m) - static_cast<double>(bin) - 0.5) > 1.5)
      continue;
    if (best == work.rays.size() || work.powers[i] > work.powers[best]) best = i;
  }
  if (best == work.rays.size()) return;
  const Vector3f p = work.rays[best].origin + work.hits[best].range_m * work.rays[best].direction;
  strongest.push_back({static_cast<std::uint16_t>(beam), static_cast<std::uint16_t>(bin), static_cast<float>(power_db),
                       p.x(), p.y(), p.z(), work.hits[best].object});
}

void EchoTracer::trace(const core::Isometry& T_world_sensor, Random& random, EchoImage& image,
                       std::vector<StrongReturn>* strongest) const {
  image.reset(static_cast<std::size_t>(options_.rangeCount), geometry_.bearings_rad().size());
  Beam work;
  for (std::size_t beam = 0; beam < image.beamCount; ++beam) {
    makeRays(T_world_sensor, beam, random, work);
    caster_.cast(work.rays, work.hits);
    work.column.assign(image.rangeCount, 0.0f);
    work.powers.assign(work.rays.size(), 0.0);
    for (std::size_t i = 0; i < work.rays.size(); ++i) {
      const RayHit& hit = work.hits[i];
      if (!hit.hit()) continue;
      const Vector3f p_world = work.rays[i].origin + hit.range_m * work.rays[i].direction;
      const double onAxis =
          work.solidAngles[i] * patchPower(hit.range_m, -hit.normal.dot(work.rays[i].direction),
                                           scene_.materials[scene_.objects[hit.object].material], p_world);
      work.powers[i] = gains_[i] * onAxis;
      deposit(work, i, work.powers[i], work.column);
      if (options_.multipath) addGhosts(T_world_sensor, work, i, onAxis, image);
    }
    for (std::size_t bin = 0; bin < image.rangeCount; ++bin) image.at(bin, beam) += work.column[bin];
    if (strongest) findStrongest(work, beam, *strongest);
  }
  if (options_.volume) addVolume(image);
}

}  // namespace s2s::sim
