#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "s2s/odometry/options.h"

namespace s2s::odometry {

/// The plane that a point belongs to.
struct PlaneMatch {
  Eigen::Vector3d normal;  ///< unit; its sign has no meaning
  double distance_m = 0;   ///< of the point, along the normal
  double variance_m2 = 0;  ///< of that distance, from the plane's own uncertainty at the point
  /// Of the normal, about the axis known worst; includes a share for the shape of what is no true plane.
  double tiltVariance_rad2 = 0;
};

/// Local map of planes in cubic voxels of several sizes.
///
/// Every voxel keeps count, mean and covariance of its points, updated point by point (Welford), and the plane through
/// them if they are flat. A point is matched to the plane of the largest flat voxel around it: large planes are known
/// best, and what is not flat at one size may be at the next smaller one. A voxel settles after some points, so that
/// the map does not follow the errors of later poses.
///
/// The idea of planes with uncertainty in voxels of several sizes is that of Yuan et al., "Efficient and Probabilistic
/// Adaptive Voxel Mapping for Accurate Online LiDAR Odometry", RA-L 2022.
class PlaneMap {
 public:
  explicit PlaneMap(const PlaneMapOptions& options);

  void insert(const std::vector<Eigen::Vector3d>& points);

  /// Plane at a point; false if there is none.
  bool match(const Eigen::Vector3d& point, PlaneMatch& out) const;

  /// Drops voxels whose centre is further than `radius_m` from `centre`.
  void forgetBeyond(const Eigen::Vector3d& centre, double radius_m);

  void clear();
  bool empty() const { return levels_.front().voxels.empty(); }
  /// Voxels of all levels.
  std::size_t size() const;

 private:
  struct Voxel {
    std::uint64_t key = 0;
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();  // from the voxel's centre
    std::array<float, 6> scatter{};                  // xx xy xz yy yz zz, sums of products about the mean
    std::int32_t count = 0;
    std::int32_t fitCount = 0;  // count at the last fit
    bool isPlane = false;
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    float offsetVariance = 0;  // of the plane at the mean
    float tiltVariance = 0;    // of the normal, about the axis known worst [rad^2]
  };
  /// Open-addressing hash from a voxel's key to its place in `voxels`.
  struct Level {
    double size_m = 0;
    std::vector<Voxel> voxels;
    std::vector<std::uint32_t> slots;  // place + 1, 0 is free; a power of two of them
  };

  static std::size_t slotOf(const Level& level, std::uint64_t key);
  static void grow(Level& level);
  static Voxel& findOrAdd(Level& level, std::uint64_t key);
  void fit(Voxel& voxel, double size_m) const;

  PlaneMapOptions options_;
  std::vector<Level> levels_;           // coarse to fine
  std::vector<std::uint32_t> touched_;  // scratch of insert
};

}  // namespace s2s::odometry
