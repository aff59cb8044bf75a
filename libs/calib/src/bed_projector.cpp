#include "bed_projector.h"

#include <algorithm>
#include <cmath>

namespace s2s::calib {

namespace {

constexpr std::size_t kAnchorBeams = 4, kAnchorBins = 8;  // places in between are interpolated
constexpr double kAnchorMargin = 1.4;  // anchors may lie outside the elevations in use by this factor
constexpr double kLeastRise = 0.15;    // metres of height per radian and metre of range: less grazes the bed
constexpr double kAngleStep = 1e-4;
constexpr int kIterations = 6;
constexpr double kConverged_m = 0.003;
constexpr double kMaxBearing_rad = 1.0;

}  // namespace

Eigen::Vector3d BedProjector::place(double bearing_rad, double range_m, double elevation_rad,
                                    const PingMotion& motion) const {
  const double* const correction = sonar_.correction.data();
  const CorrectedBeam<double> beam(range_m, bearing_rad, sonar_, correction, soundSpeed_mps_);
  return toMap<double>(toVehicle<double>(beamPoint<double>(beam, elevation_rad, sonar_.model), sonar_, correction),
                       motion, correction);
}

BedProjector::Anchor BedProjector::meet(double bearing_rad, double range_m, const PingMotion& motion,
                                        double start_rad) const {
  Anchor anchor;
  anchor.done = true;
  double elevation = start_rad;
  for (int k = 0; k < kIterations; ++k) {
    const Eigen::Vector3d p = place(bearing_rad, range_m, elevation, motion);
    const auto bed = grid_.at(p.x(), p.y());
    if (!bed) return anchor;
    const double gap_m = p.z() - bed->height_m - sonar_.correction[kTextureTilt] * elevation;
    if (std::abs(gap_m) < kConverged_m) {
      anchor.valid = std::abs(elevation) < kAnchorMargin * largestElevation();
      anchor.x_m = static_cast<float>(p.x());
      anchor.y_m = static_cast<float>(p.y());
      anchor.elevation_rad = static_cast<float>(elevation);
      return anchor;
    }
    const Eigen::Vector3d step = (place(bearing_rad, range_m, elevation + kAngleStep, motion) - p) / kAngleStep;
    const double rise = step.z() - bed->slope.dot(step.head<2>()) - sonar_.correction[kTextureTilt];
    if (std::abs(rise) < kLeastRise * range_m) return anchor;
    elevation = std::clamp(elevation - gap_m / rise, -0.6, 0.6);
  }
  return anchor;
}

void BedProjector::project(const TexturePing& ping, const PingMotion& motion,
                           std::vector<BedPicture::Sample>& samples) const {
  std::size_t bins = 0;
  for (const auto& beam : ping.beams) bins = std::max(bins, beam.firstBin + beam.contrast.size());
  const std::size_t columns = bins / kAnchorBins + 2;
  std::vector<Anchor> anchors((ping.beams.size() / kAnchorBeams + 1) * columns);
  const auto anchorAt = [&](std::size_t row, std::size_t column) -> const Anchor& {
    Anchor& anchor = anchors[row * columns + column];
    if (!anchor.done) {
      const double start = column > 0 && anchors[row * columns + column - 1].valid
                               ? static_cast<double>(anchors[row * columns + column - 1].elevation_rad)
                               : 0.0;
      anchor = meet(static_cast<double>(ping.beams[row * kAnchorBeams].bearing_rad),
                    ping.binRange_m(column * kAnchorBins), motion, start);
    }
    return anchor;
  };
  const auto limit = static_cast<float>(largestElevation());
  for (std::size_t b = 0; b + kAnchorBeams < ping.beams.size(); ++b) {
    const auto& beam = ping.beams[b];
    if (std::abs(beam.bearing_rad) > static_cast<float>(kMaxBearing_rad)) continue;
    const std::size_t row = b / kAnchorBeams;
    const float v = static_cast<float>(b % kAnchorBeams) / static_cast<float>(kAnchorBeams);
    for (std::size_t k = 0; k < beam.contrast.size(); ++k) {
      const std::size_t bin = beam.firstBin + k, column = bin / kAnchorBins;
      const Anchor &a = anchorAt(row, column), &c = anchorAt(row, column + 1);
      const Anchor &d = anchorAt(row + 1, column), &e = anchorAt(row + 1, column + 1);
      if (!a.valid || !c.valid || !d.valid || !e.valid) continue;
      const float u = static_cast<float>(bin % kAnchorBins) / static_cast<float>(kAnchorBins);
      const auto mix = [u, v](float p, float q, float r, float s) {
        return (1 - v) * ((1 - u) * p + u * q) + v * ((1 - u) * r + u * s);
      };
      if (std::abs(mix(a.elevation_rad, c.elevation_rad, d.elevation_rad, e.elevation_rad)) > limit) continue;
      samples.push_back({mix(a.x_m, c.x_m, d.x_m, e.x_m), mix(a.y_m, c.y_m, d.y_m, e.y_m),
                         static_cast<float>(beam.contrast[k]) / kContrastScale});
    }
  }
}

std::optional<BedSight> BedProjector::sightOf(const Eigen::Vector3d& p_map, const Eigen::Vector2d& slope,
                                              const PingMotion& motion) const {
  const core::Isometry T_sonar_map = (motion.T_map_vehicle * sonar_.corrected()).inverse();
  const auto elevationOf = [](const Eigen::Vector3d& p) { return std::asin(std::clamp(p.z() / p.norm(), -1.0, 1.0)); };
  const double lift_m = sonar_.correction[kTextureTilt] * elevationOf(T_sonar_map * p_map);
  const Eigen::Vector3d p = T_sonar_map * (p_map + Eigen::Vector3d(0, 0, lift_m));
  const double range_m = p.norm(), elevation = elevationOf(p);
  const double sinBearing =
      sonar_.model == obs::BearingModel::Azimuth ? p.y() / std::hypot(p.x(), p.y()) : p.y() / range_m;
  const double ratio = soundSpeed_mps_ / sonar_.deviceSoundSpeed_mps;
  if (p.x() <= 0 || std::abs(sinBearing / ratio) > std::sin(kMaxBearing_rad) ||
      std::abs(elevation) > largestElevation())
    return {};
  BedSight sight;
  sight.motion = &motion;
  sight.elevation_rad = elevation;
  const double bearing = std::asin(sinBearing / ratio);
  sight.echo.bearing_rad = static_cast<float>(bearing);
  sight.echo.range_m = static_cast<float>(range_m / ratio);
  const auto range = static_cast<double>(sight.echo.range_m);
  const Eigen::Vector3d step =
      (place(bearing, range, elevation + kAngleStep, motion) - place(bearing, range, elevation - kAngleStep, motion)) /
      (2 * kAngleStep);
  sight.rise_mPerRad = step.z() - slope.dot(step.head<2>()) - sonar_.correction[kTextureTilt];
  if (std::abs(sight.rise_mPerRad) < kLeastRise * range_m) return {};
  return sight;
}

}  // namespace s2s::calib
