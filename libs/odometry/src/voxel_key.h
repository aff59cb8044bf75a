#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

namespace s2s::odometry {

/// A voxel's three indices in 21 bits each; wraps beyond a million voxels from the origin.
constexpr std::uint64_t kNoVoxel = ~std::uint64_t{0};
constexpr int kVoxelBits = 21;
constexpr std::uint64_t kVoxelMask = (std::uint64_t{1} << kVoxelBits) - 1;
constexpr std::int64_t kVoxelBias = std::int64_t{1} << (kVoxelBits - 1);

/// Key of the voxel around a point whose coordinates count in voxel edges.
template <class Vector3>
std::uint64_t voxelKey(const Vector3& scaled) {
  const auto part = [](double value) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(value)) + kVoxelBias) & kVoxelMask;
  };
  return part(scaled.x()) | part(scaled.y()) << kVoxelBits | part(scaled.z()) << (2 * kVoxelBits);
}

/// Centre of the voxel, in voxel edges.
inline Eigen::Vector3d voxelCentre(std::uint64_t key) {
  const auto part = [key](int axis) {
    return static_cast<double>(static_cast<std::int64_t>((key >> (axis * kVoxelBits)) & kVoxelMask) - kVoxelBias) + 0.5;
  };
  return {part(0), part(1), part(2)};
}

/// Mixes a key's bits (the finaliser of splitmix64).
inline std::size_t voxelHash(std::uint64_t key) {
  key = (key ^ (key >> 30)) * 0xbf58476d1ce4e5b9ULL;
  key = (key ^ (key >> 27)) * 0x94d049bb133111ebULL;
  return static_cast<std::size_t>(key ^ (key >> 31));
}

}  // namespace s2s::odometry
