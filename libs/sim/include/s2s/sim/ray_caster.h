#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "s2s/sim/scene.h"

namespace s2s::sim {

struct Ray {
  Eigen::Vector3f origin;
  Eigen::Vector3f direction;  ///< unit length
  float maxRange_m = 0;
};

struct RayHit {
  static constexpr std::uint32_t kNothing = 0xffffffffu;
  std::uint32_t object = kNothing;  ///< index in the objects given
  float range_m = 0;
  Eigen::Vector3f normal;  ///< unit length, towards the ray's origin
  bool hit() const { return object != kNothing; }
};

/// Finds what rays meet in a scene; Embree's bounding volume hierarchy underneath. Safe to use from many threads.
class RayCaster {
 public:
  /// Copies the objects' triangles.
  explicit RayCaster(const std::vector<SceneObject>& objects);
  ~RayCaster();
  RayCaster(const RayCaster&) = delete;
  RayCaster& operator=(const RayCaster&) = delete;

  /// Casts all rays; `hits` gets as many entries. Rays that lie next to each other should point alike.
  void cast(const std::vector<Ray>& rays, std::vector<RayHit>& hits) const;
  RayHit cast(const Ray& ray) const;

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
};

}  // namespace s2s::sim
