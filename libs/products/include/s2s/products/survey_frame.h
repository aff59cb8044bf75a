#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>

#include "s2s/core/trajectory.h"
#include "s2s/map/map_point.h"
#include "s2s/products/cloud_statistics.h"

namespace s2s::products {

/// The horizontal frame in which a survey is drawn: origin in the path's middle, "along" the path's principal direction
/// (towards growing x of the map), "across" to the left of it. Without a path, the map's box takes its place.
struct SurveyFrame {
  Eigen::Vector2d middle_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();
  Eigen::Vector2d low_m = Eigen::Vector2d::Zero();   ///< smallest (along, across) of the path
  Eigen::Vector2d high_m = Eigen::Vector2d::Zero();  ///< largest

  SurveyFrame() = default;
  SurveyFrame(const core::Trajectory& path, const CloudStatistics& statistics);

  Eigen::Vector2d across() const { return {-along.y(), along.x()}; }
  /// (along, across) of a point of the map.
  Eigen::Vector2d local(const Eigen::Vector3d& p_map) const {
    const Eigen::Vector2d q = p_map.head<2>() - middle_m;
    return {along.dot(q), across().dot(q)};
  }
  Eigen::Vector3d toMap(double along_m, double across_m, double z) const {
    const Eigen::Vector2d p = middle_m + along_m * along + across_m * across();
    return {p.x(), p.y(), z};
  }
};

/// Finds where a cross section shows most of both worlds.
class CrossSectionFinder {
 public:
  CrossSectionFinder(const SurveyFrame& frame, double thickness_m)
      : middle_m_(frame.middle_m), along_(frame.along), thickness_m_(thickness_m) {}
  void add(const map::MapPoint& point);
  /// The station with the largest product of LiDAR and sonar points in a slab; zero without either.
  double station_m() const;

 private:
  struct Counts {
    std::uint64_t lidar = 0, sonar = 0;
  };
  Eigen::Vector2d middle_m_, along_;
  double thickness_m_;
  std::unordered_map<std::int64_t, Counts> slabs_;
};

}  // namespace s2s::products
