#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "s2s/core/time.h"

namespace s2s::map {

/// Lets one point a voxel through, and a further one only when a time has passed since.
///
/// A hash table with open addressing; voxels whose time has passed are dropped when it grows, so memory stays bounded
/// by what is seen within the window.
class VoxelThinner {
 public:
  /// @param voxel_m  edge of a voxel, greater than zero
  /// @param window_s time after which a voxel accepts again
  /// Voxels are counted modulo 2^21 an axis: 200 km at 10 cm before two share a cell.
  bool accept(const Eigen::Vector3d& p, core::TimeNs time, double voxel_m, double window_s);
  void clear() { *this = VoxelThinner(); }
  std::size_t memory_bytes() const { return slots_.size() * sizeof(Slot); }

 private:
  struct Slot {
    std::uint64_t key = kFree;
    core::TimeNs time = 0;
  };
  static constexpr std::uint64_t kFree = ~std::uint64_t{0};  // no key uses the top bit

  Slot& slotOf(std::uint64_t key);
  void grow(core::TimeNs now, core::TimeNs window);

  std::vector<Slot> slots_;
  std::size_t used_ = 0;
};

}  // namespace s2s::map
