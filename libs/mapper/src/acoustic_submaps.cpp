#include "s2s/mapper/acoustic_submaps.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "s2s/map/sonar_scans.h"

namespace s2s::mapper {

namespace {

/// A piece of path shorter than this share of a submap's length is not worth one.
constexpr double kLeastLength = 0.5;
/// Pings of one sonar nearer to each other along the path than this tell the same.
constexpr double kPingSpacing_m = 0.12;
/// Standard deviation of the elevation at which a sonar's aperture ends for the leading edge: it depends on how bright
/// the seabed is beside the threshold, alike for all returns of a survey.
constexpr double kEdgeSigma_rad = 2.0 * M_PI / 180;
/// Standard deviation of the shift of all bearings towards where the range is less, in the sine of the bearing: a share
/// of the beam's width, which is even in the sine.
constexpr double kBearingShift = 1.0 * M_PI / 180;
/// Returns this much outside the other sonar's aperture are no part of its stereo points.
constexpr double kApertureMargin_rad = 2 * M_PI / 180;

map::StoredLineScan stored(const SonarScan& scan) {
  map::ScanPose pose;
  pose.layer = scan.layer;
  pose.time = scan.time;
  pose.T_odom_vehicle = scan.T_odom_vehicle;
  return map::toStored(pose, map::toMapLineScan(scan.line, scan.T_vehicle_sonar));
}

bool isSeabed(const map::PackedReturn& r) {
  return r.order == 0 && (r.source == map::ElevationSource::Seabed || r.source == map::ElevationSource::LowestPoint);
}

/// A point on its arc, and where it would be if the aperture ended elsewhere or the bearing was another.
graph::AcousticPoint swathPoint(const map::PackedReturn& r, obs::BearingModel model,
                                const core::Isometry& T_middle_sonar) {
  const Eigen::Vector3d p_sonar = map::pointOf(r, model);
  map::PackedReturn further = r, wider = r;
  const double outward_rad = r.elevation < 0 ? -kEdgeSigma_rad : kEdgeSigma_rad;
  further.elevation = static_cast<std::int16_t>(r.elevation + std::lround(outward_rad / map::kElevationStep_rad));
  // On a level seabed ranges grow with the bearing's distance from the middle.
  wider.bearing_rad += static_cast<float>(std::copysign(kBearingShift, r.bearing_rad) / std::cos(r.bearing_rad));
  graph::SharedErrors shared_sonar_m;
  shared_sonar_m << (map::pointOf(further, model) - p_sonar).cast<float>(),
      (map::pointOf(wider, model) - p_sonar).cast<float>();
  return {(T_middle_sonar * p_sonar).cast<float>(), static_cast<float>(map::decodeSigma(r.sigmaCode)),
          T_middle_sonar.linear().cast<float>() * shared_sonar_m};
}

double distance_m(const SonarScan& a, const SonarScan& b) {
  return (a.T_odom_vehicle.translation() - b.T_odom_vehicle.translation()).norm();
}

}  // namespace

AcousticSubmaps::AcousticSubmaps(const graph::SonarFactorOptions& options, const map::ResolverOptions& resolver)
    : options_(options), resolverOptions_(resolver) {}

std::optional<graph::AcousticSubmap> AcousticSubmaps::add(const SonarScan& scan) {
  if (!options_.enabled) return std::nullopt;
  std::optional<graph::AcousticSubmap> submap;
  if (isComplete(scan)) submap = build();
  scans_.push_back(scan);
  return submap;
}

std::optional<graph::AcousticSubmap> AcousticSubmaps::finish() { return build(); }

bool AcousticSubmaps::isComplete(const SonarScan& next) const {
  if (scans_.empty()) return false;
  return distance_m(scans_.front(), next) >= options_.submap_m ||
         core::secondsBetween(scans_.front().time, next.time) >= options_.maxSubmap_s;
}

std::optional<graph::AcousticSubmap> AcousticSubmaps::build() {
  std::optional<graph::AcousticSubmap> submap;
  if (!scans_.empty() && distance_m(scans_.front(), scans_.back()) >= kLeastLength * options_.submap_m) {
    const SonarScan& middle = scans_[scans_.size() / 2];
    submap.emplace();
    submap->time = middle.time;
    submap->T_odom_vehicle = middle.T_odom_vehicle;
    const core::Isometry T_middle_odom = middle.T_odom_vehicle.inverse();
    addStereo(T_middle_odom, *submap);
    addSwath(T_middle_odom, *submap);
  }
  scans_.clear();
  return submap;
}

void AcousticSubmaps::addStereo(const core::Isometry& T_middle_odom, graph::AcousticSubmap& submap) const {
  for (const SonarScan& scan : scans_) {
    if (scan.layer != map::Layer::Stereo) continue;
    graph::AcousticCloud points;
    points.reserve(scan.points.size());
    for (const auto& point : scan.points)
      points.push_back({point.p_vehicle, point.sigma_m, graph::SharedErrors::Zero()});
    appendTransformed(T_middle_odom * scan.T_odom_vehicle, points, submap.stereo_vehicle);
  }
}

void AcousticSubmaps::addSwath(const core::Isometry& T_middle_odom, graph::AcousticSubmap& submap) {
  map::LineScanResolver resolver;
  resolver.reset(resolverOptions_);
  double otherAperture_rad = 0;
  const auto resolveFirst = [&](map::StoredLineScan& scan) {
    resolver.resolve(scan, scan.pose.T_odom_vehicle, map::LineScanResolver::Pass::First);
    resolver.addLineScan(scan, scan.pose.T_odom_vehicle);
  };
  std::vector<map::StoredLineScan> swaths;
  std::map<map::Layer, const SonarScan*> last;
  for (const SonarScan& scan : scans_) {
    const SonarScan*& before = last[scan.layer];
    if (scan.layer != map::Layer::Stereo && before && distance_m(*before, scan) < kPingSpacing_m) continue;
    before = &scan;
    if (scan.layer == map::Layer::Stereo) {
      for (const auto& point : scan.points)
        resolver.addStereoPoint(scan.T_odom_vehicle * point.p_vehicle.cast<double>(), point.sigma_m);
    } else if (scan.layer == map::Layer::LineVertical) {
      map::StoredLineScan profile = stored(scan);
      otherAperture_rad = profile.verticalAperture_rad;
      resolveFirst(profile);
    } else {
      swaths.push_back(stored(scan));
    }
  }
  for (auto& scan : swaths) resolveFirst(scan);
  for (auto& scan : swaths) {
    resolver.resolve(scan, scan.pose.T_odom_vehicle, map::LineScanResolver::Pass::First);
    const core::Isometry T_middle_sonar = T_middle_odom * scan.pose.T_odom_vehicle * scan.T_vehicle_sonar;
    for (const map::PackedReturn& r : scan.returns)
      if (isSeabed(r) && std::abs(r.bearing_rad) > otherAperture_rad / 2 + kApertureMargin_rad)
        submap.swath_vehicle.push_back(swathPoint(r, scan.bearingModel, T_middle_sonar));
  }
}

}  // namespace s2s::mapper
