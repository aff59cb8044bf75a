#include "s2s/odometry/downsample.h"

#include <cmath>

#include "voxel_key.h"

namespace s2s::odometry {

std::vector<std::uint32_t> onePerCube(const std::vector<Eigen::Vector3f>& points, double cube_m) {
  std::size_t slots = 64;
  while (slots < 2 * points.size()) slots *= 2;
  std::vector<std::uint64_t> taken(slots, kNoVoxel);
  std::vector<std::uint32_t> kept;
  const auto perMetre = static_cast<float>(1.0 / cube_m);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const std::uint64_t key = voxelKey(points[i] * perMetre);
    std::size_t slot = voxelHash(key) & (slots - 1);
    while (taken[slot] != kNoVoxel && taken[slot] != key) slot = (slot + 1) & (slots - 1);
    if (taken[slot] == key) continue;
    taken[slot] = key;
    kept.push_back(i);
  }
  return kept;
}

}  // namespace s2s::odometry
