#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "s2s/eval/mesh_query.h"
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
};

/// Sorts the points of a map to the objects of kind `object` that they belong to.
class ObjectFinder {
 public:
  /// @param reach_m points within this distance of an object's surface count
  ObjectFinder(const TruthFolder& truth, double reach_m);

  void add(map::Layer layer, const Eigen::Vector3d& p_world);

  /// One entry an object, in the order of their numbers.
  std::vector<ObjectPresence> presence() const;

 private:
  struct Candidate {
    std::unique_ptr<MeshQuery> surface;
    Eigen::Vector3d low, high;  ///< bounding box, grown by the reach
    ObjectPresence found;
    std::vector<double> heights_m;
  };
  double heightAboveSeabed(const Eigen::Vector3d& p_world) const;

  double reach_m_;
  std::unique_ptr<MeshQuery> seabed_;  ///< bare; null if the world has none
  std::vector<Candidate> candidates_;
};

}  // namespace s2s::eval
