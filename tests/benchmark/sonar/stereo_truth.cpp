#include "stereo_truth.h"

#include <cmath>
#include <ctime>
#include <limits>

#include "s2s/core/error.h"
#include "s2s/core/ini_file.h"
#include "s2s/core/option_table.h"
#include "s2s/obs/rawlog_reader.h"
#include "s2s/products/ply_reader.h"
#include "s2s/products/trajectory_files.h"

namespace s2s::bench {

namespace {

constexpr double kDeg = M_PI / 180.0;
constexpr double kSamePatch_m = 0.10;

core::Isometry mounting(const std::string& path, const std::string& label) {
  auto ini = core::IniFile::load(path);
  const auto entry = ini.read(label, "pose");
  core::Isometry T = core::Isometry::Identity();
  if (!entry || !core::parsePose(entry->value, T))
    throw core::InputError("no pose of " + label, path, "give the truth folder of simulate-survey");
  return T;
}

core::TimeNs timeOf(const obs::CObservationImagingSonar& ping) { return core::fromMrptTime(ping.timestamp); }

/// Surface points within a feature's resolution cell (pulse length along range, beam width in bearing, the aperture in
/// elevation), in the world: where its echo can have come from.
std::vector<Eigen::Vector3d> surfaceInCell(const sonar::Feature& f, const sonar::PingGeometry& geometry,
                                           const core::Isometry& T_world_sonar, const SurveyTruth& truth) {
  constexpr double kTolerance_m = 0.03, kHalfBeam_rad = 0.5 * kDeg;
  std::vector<Eigen::Vector3d> points;
  const double half_rad = 0.5 * geometry.verticalAperture_rad + 1.0 * kDeg;
  for (const double offset : {-kHalfBeam_rad, 0.0, kHalfBeam_rad})
    for (double elevation = -half_rad; elevation <= half_rad;) {
      const Eigen::Vector3d p =
          T_world_sonar * sonar::pointAt({f.range_m, f.bearing_rad + offset, elevation}, geometry.bearingModel);
      const double d = truth.distance_m(p, 1.0);
      if (d <= kTolerance_m) points.push_back(p);
      elevation += std::max(0.25 * kDeg, 0.9 * (d - kTolerance_m) / f.range_m);  // nothing can be nearer than d
    }
  return points;
}

double gapBetween(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b) {
  double gap_m = std::numeric_limits<double>::infinity();
  for (const auto& p : a)
    for (const auto& q : b) gap_m = std::min(gap_m, (p - q).norm());
  return gap_m;
}

class Scorer {
 public:
  Scorer(const sonar::SonarOptions& options, const SurveyTruth& truth)
      : stereo_(options.horizontal, options.vertical, options.stereo), truth_(truth) {}

  void add(const PingPair& pair) {
    const auto T_world_h = truth_.T_world_sensor("SONAR_HORIZONTAL", timeOf(*pair.h));
    const auto T_world_v = truth_.T_world_sensor("SONAR_VERTICAL", timeOf(*pair.v));
    if (!T_world_h || !T_world_v) return;
    const auto h = stereo_.horizontal().process(*pair.h), v = stereo_.vertical().process(*pair.v);
    const core::Isometry T_h_v = T_world_h->inverse() * *T_world_v;
    sonar::StereoTrace trace;
    const std::clock_t start = std::clock();
    const auto result = stereo_.process(h, v, T_h_v, &trace);
    score_.seconds += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    ++score_.pairs;
    addPoints(result, *T_world_h);
    addMatches(trace, h, v, *T_world_h, *T_world_v);
    addCoverage(result, h.geometry, v.geometry, *T_world_h, T_h_v.inverse());
  }

  StereoScore take() { return std::move(score_); }

 private:
  void addPoints(const sonar::StereoResult& result, const core::Isometry& T_world_h) {
    for (const auto& point : result.points) {
      const Eigen::Vector3d p_world = T_world_h * point.p_h;
      const double d = truth_.distance_m(p_world, 5.0);
      score_.points.push_back({p_world, point, d, p_world.z() - truth_.topHeight_m(p_world)});
      score_.distances_m.push_back(d);
      score_.normalised.push_back(d / point.sigma_m());
    }
  }

  void addMatches(const sonar::StereoTrace& trace, const sonar::ProcessedPing& h, const sonar::ProcessedPing& v,
                  const core::Isometry& T_world_h, const core::Isometry& T_world_v) {
    for (std::size_t i = 0; i < trace.matches.size(); i += 3) {
      const auto& match = trace.matches[i];
      const auto &feature_h = trace.features_h[match.horizontal], &feature_v = trace.features_v[match.vertical];
      const double gap_m = gapBetween(surfaceInCell(feature_h, h.geometry, T_world_h, truth_),
                                      surfaceInCell(feature_v, v.geometry, T_world_v, truth_));
      ++score_.matches;
      if (gap_m <= kSamePatch_m) ++score_.correct;
      score_.judged.push_back({score_.pairs, feature_h, feature_v, match, gap_m});
    }
  }

  void addCoverage(const sonar::StereoResult& result, const sonar::PingGeometry& h, const sonar::PingGeometry& v,
                   const core::Isometry& T_world_h, const core::Isometry& T_v_h) {
    const long half_deg = std::lround(0.5 * h.verticalAperture_rad / kDeg);
    for (long elevation_deg = -half_deg; elevation_deg <= half_deg; ++elevation_deg)
      for (int bearing_deg = -12; bearing_deg <= 12; ++bearing_deg) {
        const double elevation = static_cast<double>(elevation_deg) * kDeg, bearing = bearing_deg * kDeg;
        const Eigen::Vector3d direction = sonar::pointAt({1.0, bearing, elevation}, h.bearingModel);
        const auto hit = truth_.firstHit(T_world_h.translation(), T_world_h.linear() * direction, h.maxRange_m());
        if (!hit) continue;
        const Eigen::Vector3d p_h = T_world_h.inverse() * *hit;
        if (!sonar::isInView(v, T_v_h * p_h)) continue;
        ++score_.patches;
        for (const auto& point : result.points)
          if ((point.p_h - p_h).norm() <= kSamePatch_m) {
            ++score_.found;
            break;
          }
      }
  }

  sonar::SonarStereo stereo_;
  const SurveyTruth& truth_;
  StereoScore score_;
};

}  // namespace

SurveyTruth::SurveyTruth(const std::string& folder)
    : trajectory_(products::readTum(folder + "/truth/trajectory.tum")),
      T_vehicle_horizontal_(mounting(folder + "/truth/extrinsics.ini", "SONAR_HORIZONTAL")),
      T_vehicle_vertical_(mounting(folder + "/truth/extrinsics.ini", "SONAR_VERTICAL")),
      world_(std::make_unique<eval::MeshQuery>(products::readPlyMesh(folder + "/truth/world.ply"))) {}

std::optional<core::Isometry> SurveyTruth::T_world_sensor(const std::string& label, core::TimeNs time) const {
  const auto T = trajectory_.at(time);
  if (!T) return std::nullopt;
  return *T * (label == "SONAR_HORIZONTAL" ? T_vehicle_horizontal_ : T_vehicle_vertical_);
}

double SurveyTruth::distance_m(const Eigen::Vector3d& p_world, double limit_m) const {
  const auto nearest = world_->nearest(p_world, limit_m);
  return nearest ? nearest->distance_m : limit_m;
}

double SurveyTruth::topHeight_m(const Eigen::Vector3d& p_world) const {
  return world_->topHeight_m(p_world.x(), p_world.y()).value_or(NAN);
}

std::optional<Eigen::Vector3d> SurveyTruth::firstHit(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                                     double maxRange_m) const {
  for (double range_m = 0.3; range_m < maxRange_m;) {
    const Eigen::Vector3d p = origin + range_m * direction;
    const double d = distance_m(p, 2.0);
    if (d < 0.005) return p;
    range_m += d;
  }
  return std::nullopt;
}

std::vector<PingPair> readPairs(const std::string& rawlog, std::size_t stride) {
  std::vector<PingPair> pairs;
  obs::RawlogReader reader(rawlog);
  std::size_t count = 0;
  obs::CObservationImagingSonar::Ptr last_v;
  const auto isNearer = [](const auto& h, const auto& candidate, const auto& than) {
    return std::abs(timeOf(*candidate) - timeOf(*h)) < std::abs(timeOf(*than) - timeOf(*h));
  };
  while (const auto observation = reader.next()) {
    const auto ping = std::dynamic_pointer_cast<obs::CObservationImagingSonar>(observation);
    if (!ping) continue;
    if (ping->sensorLabel != "SONAR_VERTICAL") {
      if (count++ % stride == 0) pairs.push_back({ping, last_v});
      continue;
    }
    // Only the ping before and the one after can be the nearest: all others need not be held.
    for (auto pair = pairs.rbegin(); pair != pairs.rend() && timeOf(*pair->h) >= (last_v ? timeOf(*last_v) : 0); ++pair)
      if (!pair->v || isNearer(pair->h, ping, pair->v)) pair->v = ping;
    last_v = ping;
  }
  while (!pairs.empty() && !pairs.back().v) pairs.pop_back();
  return pairs;
}

StereoScore score(const sonar::SonarOptions& options, const std::vector<PingPair>& pairs, const SurveyTruth& truth) {
  Scorer scorer(options, truth);
  for (const PingPair& pair : pairs) scorer.add(pair);
  return scorer.take();
}

}  // namespace s2s::bench
