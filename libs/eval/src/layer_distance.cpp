#include "s2s/eval/layer_distance.h"

#include <algorithm>
#include <limits>

namespace s2s::eval {

namespace {

/// SplitMix64 (Steele, Lea & Flood 2014): neighbouring numbers get unrelated hashes.
std::uint64_t hashOf(std::uint64_t number) {
  number += 0x9E3779B97F4A7C15U;
  number = (number ^ (number >> 30U)) * 0xBF58476D1CE4E5B9U;
  number = (number ^ (number >> 27U)) * 0x94D049BB133111EBU;
  return number ^ (number >> 31U);
}

}  // namespace

void PointSample::add(const Eigen::Vector3d& p) {
  const std::uint64_t hash = hashOf(offered_++);
  if (hash > limit_) return;
  if (entries_.size() == capacity_) {
    limit_ /= 2;
    entries_.erase(
        std::remove_if(entries_.begin(), entries_.end(), [&](const Entry& entry) { return entry.hash > limit_; }),
        entries_.end());
    if (hash > limit_ || entries_.size() == capacity_) return;
  }
  entries_.push_back({hash, p});
}

std::vector<Eigen::Vector3d> PointSample::points() const {
  std::vector<Eigen::Vector3d> points;
  points.reserve(entries_.size());
  for (const auto& entry : entries_) points.push_back(entry.p);
  return points;
}

LayerDistance measureLayer(const MeshQuery& world, const std::vector<Eigen::Vector3d>& points_world,
                           std::uint64_t pointsInLayer) {
  constexpr double kFar_m = std::numeric_limits<float>::max() / 4;  // the tree's radius is single precision
  LayerDistance result;
  result.points = pointsInLayer;
  result.sampled = points_world.size();
  std::vector<double> distances_m;
  distances_m.reserve(points_world.size());
  for (const auto& p : points_world)
    if (const auto nearest = world.nearest(p, kFar_m)) distances_m.push_back(nearest->distance_m);
  result.within5cm = shareWithin(distances_m, 0.05);
  result.within10cm = shareWithin(distances_m, 0.10);
  result.within20cm = shareWithin(distances_m, 0.20);
  result.distance_m = summarise(std::move(distances_m));
  return result;
}

}  // namespace s2s::eval
