#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "s2s/core/trajectory.h"
#include "s2s/eval/mesh_query.h"

namespace s2s::eval {

/// Which parts of the true world a sensor could have seen.
struct VisibilityOptions {
  Eigen::Vector3d eye_vehicle_m = {0, 0, 0};  ///< place of the sensor on the vehicle
  double range_m = 10;
  double maxElevation_rad = 10;             ///< above and below the horizon; more than pi/2: anything
  double minHeight_m = 0, maxHeight_m = 0;  ///< heights in the world between which surfaces count
};

struct SurfaceRecallOptions {
  double spacing_m = 0.25;  ///< one sample of the surface for each square of this side
  double pathStep_m = 2;    ///< distance between the places on the path that visibility is tested from
  VisibilityOptions lidar{{0, 0, 1}, 30, 0.3927 /* 22.5 deg */, 0.05, 1e9};
  VisibilityOptions sonar{{0, 0, -0.5}, 10, 10, -1e9, -0.3};
};

/// Share in [0, 1] of the visible true surface that has a point of the map near it.
struct SurfaceRecall {
  std::size_t samples = 0;
  double area_m2 = 0;
  double within5cm = 0, within10cm = 0, within20cm = 0;
};

/// Samples of the true surface that a sensor could have seen from the path, each with the nearest point of the map.
class VisibleSurface {
 public:
  /// Samples lie at random places (fixed seed) on the triangles, by area, and are kept if a straight line of at most
  /// the range, inside the elevation limits, joins them with the sensor at some place of the path.
  VisibleSurface(const MeshQuery& world, const core::Trajectory& path_world, const VisibilityOptions& visibility,
                 const SurfaceRecallOptions& options);
  /// The same for a part of the world, such as one object; all of the world hides it.
  VisibleSurface(const MeshQuery& world, const products::PlyMesh& part, const core::Trajectory& path_world,
                 const VisibilityOptions& visibility, const SurfaceRecallOptions& options);

  /// A point of the map, in the world frame.
  void add(const Eigen::Vector3d& p_world);

  SurfaceRecall recall() const;

 private:
  static constexpr double kReach_m = 0.2;          ///< the largest distance asked for
  static constexpr double kCell_m = 2 * kReach_m;  ///< so that eight cells hold all samples within reach
  struct Sample {
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    double squaredDistance_m2 = 1e300;
  };
  static std::uint64_t keyOf(const Eigen::Vector3i& cell);

  std::vector<Sample> samples_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
  double spacing_m_;
};

/// Harmonic mean of precision and recall; zero if both are.
double fScore(double precision, double recall);

}  // namespace s2s::eval
