#pragma once

#include <cstdint>
#include <vector>

#include "s2s/eval/mesh_query.h"
#include "s2s/eval/statistics.h"

namespace s2s::eval {

/// A sample of a stream of points that never holds more than `capacity` of them. Whether a point belongs to it depends
/// on its number alone (a hash of it), so the sample is the same in every run, and has no beat with beams or columns as
/// every n-th point would.
class PointSample {
 public:
  /// @pre `capacity` >= 1
  explicit PointSample(std::size_t capacity) : capacity_(capacity) {}

  void add(const Eigen::Vector3d& p);

  std::uint64_t offered() const { return offered_; }
  /// All points offered if they fitted, else half to all of `capacity`.
  std::vector<Eigen::Vector3d> points() const;

 private:
  struct Entry {
    std::uint64_t hash = 0;
    Eigen::Vector3d p;
  };
  std::size_t capacity_;
  std::uint64_t offered_ = 0;
  std::uint64_t limit_ = ~std::uint64_t{0};  ///< hashes above are left out
  std::vector<Entry> entries_;
};

/// Distances of a layer's points from the true surfaces.
struct LayerDistance {
  std::uint64_t points = 0;                              ///< in the layer
  std::uint64_t sampled = 0;                             ///< of these measured
  Summary distance_m;                                    ///< to the nearest point of the mesh
  double within5cm = 0, within10cm = 0, within20cm = 0;  ///< shares in [0, 1]
};

/// @param points_world a sample of the layer in the world frame
LayerDistance measureLayer(const MeshQuery& world, const std::vector<Eigen::Vector3d>& points_world,
                           std::uint64_t pointsInLayer);

}  // namespace s2s::eval
