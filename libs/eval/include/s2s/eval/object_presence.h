#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "s2s/eval/mesh_query.h"
#include "s2s/eval/surface_recall.h"
#include "s2s/eval/truth_folder.h"
#include "s2s/map/map_point.h"

namespace s2s::eval {

/// How a true object on the seabed shows in the map.
struct ObjectPresence {
  std::string name;
  std::array<std::uint64_t, map::kLayers.size()> near{};  ///< points within the reach of its surface, by layer
  std::array<std::uint64_t, map::kLayers.size()> own{};   ///< of these: nearer to it than to the bare seabed
  double trueHeight_m = 0;    ///< largest height of its corners above the bare seabed; NaN if there is none below
  double mappedHeight_m = 0;  ///< 95th percentile of its own points' height above the bare seabed; NaN without any
  double seenArea_m2 = 0;     ///< of its surface that the sonars could see from the path; zero if that was not asked
  double covered = 0;         ///< share of that area with a point of the sonars within 0.1 m
};

/// A point of the map near an object.
struct ObjectPoint {
  map::Layer layer = map::Layer::Stereo;
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();
};

/// Sorts the points of a map to the objects of kind `object` that they belong to.
class ObjectFinder {
 public:
  /// @param reach_m points within this distance of an object's surface count
  ObjectFinder(const TruthFolder& truth, double reach_m);

  /// Also measure how much of each object's visible surface has points; call it before the first `add`.
  void measureCover(const MeshQuery& world, const core::Trajectory& path_world, SurfaceRecallOptions options);
  /// Also keep the points of the sonars within a margin of each object's bounding box, for pictures.
  void keepPoints(double margin_m) { margin_m_ = margin_m; }

  void add(map::Layer layer, const Eigen::Vector3d& p_world);

  /// Surface and kept points of an object, by its place in `presence`.
  const products::PlyMesh& surfaceOf(std::size_t object) const { return candidates_[object].surface->mesh(); }
  const std::vector<ObjectPoint>& pointsOf(std::size_t object) const { return candidates_[object].kept; }

  /// Height above the bare seabed; NaN where there is none.
  double heightAboveSeabed(const Eigen::Vector3d& p_world) const;

  /// One entry an object, in the order of their numbers.
  std::vector<ObjectPresence> presence() const;

 private:
  struct Candidate {
    std::unique_ptr<MeshQuery> surface;
    Eigen::Vector3d low, high;  ///< bounding box, grown by the reach
    ObjectPresence found;
    std::vector<double> heights_m;
    std::unique_ptr<VisibleSurface> seen;
    std::vector<ObjectPoint> kept;
  };
  double reach_m_, margin_m_ = 0;
  std::unique_ptr<MeshQuery> seabed_;  ///< bare; null if the world has none
  std::vector<Candidate> candidates_;
};

}  // namespace s2s::eval
