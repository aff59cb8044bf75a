#include "s2s/map/voxel_thinner.h"

#include <algorithm>
#include <cmath>

namespace s2s::map {

namespace {

constexpr std::size_t kFirstSize = 1u << 12;
constexpr std::uint64_t kAxisMask = (1u << 21) - 1;

std::uint64_t keyOf(const Eigen::Vector3d& p, double voxel_m) {
  const auto axis = [voxel_m](double coordinate) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(coordinate / voxel_m))) & kAxisMask;
  };
  return (axis(p.x()) << 42) | (axis(p.y()) << 21) | axis(p.z());
}

/// Finaliser of MurmurHash3 (public domain): neighbouring voxels must not share a run of slots.
std::uint64_t mixed(std::uint64_t key) {
  key ^= key >> 33;
  key *= 0xff51afd7ed558ccdULL;
  key ^= key >> 33;
  key *= 0xc4ceb9fe1a85ec53ULL;
  return key ^ (key >> 33);
}

}  // namespace

VoxelThinner::Slot& VoxelThinner::slotOf(std::uint64_t key) {
  const std::size_t mask = slots_.size() - 1;
  std::size_t i = mixed(key) & mask;
  while (slots_[i].key != key && slots_[i].key != kFree) i = (i + 1) & mask;
  return slots_[i];
}

void VoxelThinner::grow(core::TimeNs now, core::TimeNs window) {
  std::vector<Slot> old;
  old.swap(slots_);
  const auto isAlive = [now, window](const Slot& slot) {
    return slot.key != kFree && std::abs(now - slot.time) < window;
  };
  const auto alive = static_cast<std::size_t>(std::count_if(old.begin(), old.end(), isAlive));
  std::size_t size = kFirstSize;
  while (size < 4 * alive) size *= 2;
  slots_.resize(size);
  used_ = alive;
  for (const Slot& slot : old)
    if (isAlive(slot)) slotOf(slot.key) = slot;
}

bool VoxelThinner::accept(const Eigen::Vector3d& p, core::TimeNs time, double voxel_m, double window_s) {
  // With no window a scan is thinned by itself: its points share one time, which is then the only one that counts.
  const core::TimeNs window = std::max<core::TimeNs>(1, core::durationNs(window_s));
  if (2 * (used_ + 1) > slots_.size()) grow(time, window);
  const std::uint64_t key = keyOf(p, voxel_m);
  Slot& slot = slotOf(key);
  if (slot.key == key && std::abs(time - slot.time) < window) return false;
  if (slot.key != key) ++used_;
  slot = {key, time};
  return true;
}

}  // namespace s2s::map
