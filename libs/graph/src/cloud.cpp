#include "s2s/graph/cloud.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace s2s::graph {

namespace {

struct Keyed {
  std::array<std::int32_t, 3> cell;
  std::size_t index;
  bool operator<(const Keyed& other) const { return cell != other.cell ? cell < other.cell : index < other.index; }
};

}  // namespace

Cloud voxelDownsample(const Cloud& points, double voxel_m) {
  const auto scale = static_cast<float>(1 / voxel_m);
  std::vector<Keyed> keyed;
  keyed.reserve(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (!points[p].allFinite()) continue;
    const Eigen::Vector3f cell = (points[p] * scale).array().floor();
    keyed.push_back({{static_cast<std::int32_t>(cell.x()), static_cast<std::int32_t>(cell.y()),
                      static_cast<std::int32_t>(cell.z())},
                     p});
  }
  std::sort(keyed.begin(), keyed.end());
  Cloud thinned;
  for (std::size_t begin = 0; begin < keyed.size();) {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    std::size_t end = begin;
    for (; end < keyed.size() && keyed[end].cell == keyed[begin].cell; ++end) sum += points[keyed[end].index];
    thinned.emplace_back(sum / static_cast<float>(end - begin));
    begin = end;
  }
  return thinned;
}

Cloud voxelDownsampleTo(const Cloud& points, double voxel_m, std::size_t maxPoints) {
  Cloud thinned = voxelDownsample(points, voxel_m);
  while (thinned.size() > maxPoints) {
    // Surfaces: the count falls with the square of the edge.
    voxel_m *= std::max(1.05, std::sqrt(static_cast<double>(thinned.size()) / static_cast<double>(maxPoints)));
    thinned = voxelDownsample(points, voxel_m);
  }
  return thinned;
}

void appendTransformed(const core::Isometry& T, const Cloud& points, Cloud& to) {
  const Eigen::Isometry3f Tf = T.cast<float>();
  to.reserve(to.size() + points.size());
  for (const auto& point : points) to.emplace_back(Tf * point);
}

}  // namespace s2s::graph
