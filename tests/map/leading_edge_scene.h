#pragma once

#include <functional>
#include <optional>
#include <random>
#include <vector>

#include "s2s/core/transform.h"
#include "s2s/map/scan.h"
#include "s2s/sonar/ping_geometry.h"

namespace s2s::test {

/// A part of a plane, n . p = d, seen from the side that n points to.
struct PlanePatch {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset_m = 0;
  std::function<bool(const Eigen::Vector3d&)> covers = [](const Eigen::Vector3d&) { return true; };
};

/// Leading edges of ideal sonars in a scene of planes: the range of a beam is that of the nearest surface over all
/// elevations of its aperture.
class LeadingEdgeScene {
 public:
  void add(const PlanePatch& patch) { patches_.push_back(patch); }

  /// A level seabed at a height.
  static PlanePatch seabed(double z_m) { return {Eigen::Vector3d::UnitZ(), z_m}; }

  double range_m(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const PlanePatch& patch : patches_) {
      const double t = (patch.offset_m - patch.normal.dot(origin)) / patch.normal.dot(direction);
      if (t > 0 && t < nearest && patch.covers(origin + t * direction)) nearest = t;
    }
    return nearest;
  }

  /// @param noise_m standard deviation of the ranges; the returned sigma is that or 1 mm
  map::LineScan ping(const core::Isometry& T_map_vehicle, const core::Isometry& T_vehicle_sonar, double halfFan_rad,
                     int beams, obs::BearingModel model = obs::BearingModel::Azimuth, double noise_m = 0) {
    map::LineScan scan;
    scan.T_vehicle_sonar = T_vehicle_sonar;
    scan.verticalAperture_rad = kAperture_rad;
    scan.bearingModel = model;
    const core::Isometry T_map_sonar = T_map_vehicle * T_vehicle_sonar;
    std::normal_distribution<double> noise(0, noise_m);
    for (int beam = 0; beam < beams; ++beam) {
      const double bearing = halfFan_rad * (2.0 * beam / (beams - 1) - 1);
      const double range = leadingEdge(T_map_sonar, bearing, model);
      if (range > kMaxRange_m) continue;
      scan.returns.push_back({static_cast<float>(range + (noise_m > 0 ? noise(random_) : 0)),
                              static_cast<float>(bearing), 200, static_cast<float>(std::max(1e-3, noise_m))});
    }
    return scan;
  }

  /// 401 elevations: the range of an inner minimum is then wrong by less than r (0.05 deg / 2)^2 / 2 = 1 um at 10 m.
  double leadingEdge(const core::Isometry& T_map_sonar, double bearing_rad, obs::BearingModel model) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (int i = -200; i <= 200; ++i) {
      const Eigen::Vector3d direction =
          T_map_sonar.linear() * sonar::pointAt({1.0, bearing_rad, heardHalf_rad * i / 200}, model);
      nearest = std::min(nearest, range_m(T_map_sonar.translation(), direction));
    }
    return nearest;
  }

  static constexpr double kAperture_rad = 20.0 * M_PI / 180.0;
  /// Up to which elevation an echo is heard; the pings claim the nominal half of the aperture all the same.
  double heardHalf_rad = 0.5 * kAperture_rad;
  static constexpr double kMaxRange_m = 10.0;

 private:
  std::vector<PlanePatch> patches_;
  std::mt19937 random_{7};
};

constexpr double kDegree = M_PI / 180.0;

/// The two sonars of the paper, pitched 45 degrees down, 0.4 m under the waterline and 0.15 m apart.
inline core::Isometry horizontalMount() { return core::isometryFromXyzYpr(0, 0, -0.4, 0, 45 * kDegree, 0); }
inline core::Isometry verticalMount() { return core::isometryFromXyzYpr(0, 0.15, -0.4, 0, 45 * kDegree, 90 * kDegree); }
constexpr double kHorizontalHalfFan = 65 * kDegree, kVerticalHalfFan = 22.5 * kDegree;

}  // namespace s2s::test
