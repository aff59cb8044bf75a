#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "s2s/products/ply_reader.h"

namespace s2s::eval {

/// Nearest point of a triangle.
Eigen::Vector3d closestPointOnTriangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                       const Eigen::Vector3d& c);

/// Distances to a mesh and heights on it. The tree is Embree's, in single precision about the mesh's centre; what is
/// returned is computed from the triangle found, in double precision.
class MeshQuery {
 public:
  /// @pre the mesh has at least one triangle
  explicit MeshQuery(products::PlyMesh mesh);
  ~MeshQuery();
  MeshQuery(const MeshQuery&) = delete;
  MeshQuery& operator=(const MeshQuery&) = delete;

  struct Nearest {
    double distance_m = 0;
    std::size_t triangle = 0;
  };
  /// The nearest triangle within `maxDistance_m`, and how far it is. Nothing if there is none.
  std::optional<Nearest> nearest(const Eigen::Vector3d& p, double maxDistance_m) const;

  /// Height z of the topmost surface above or below (x, y). Nothing beside the mesh.
  std::optional<double> topHeight_m(double x, double y) const;

  /// True if the straight line between two places meets the mesh, but for its last millimetres at either end.
  bool blocked(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

  const products::PlyMesh& mesh() const { return mesh_; }

 private:
  struct Embree;
  products::PlyMesh mesh_;
  std::unique_ptr<Embree> embree_;
};

}  // namespace s2s::eval
