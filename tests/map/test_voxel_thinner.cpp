#include <gtest/gtest.h>

#include <random>
#include <set>
#include <tuple>

#include "s2s/map/voxel_thinner.h"

namespace {

using s2s::core::kNsPerSecond;
using s2s::map::VoxelThinner;

TEST(VoxelThinner, RandomPoints_SameAsASetOfVoxels) {
  std::mt19937 random(1);
  VoxelThinner thinner;
  std::set<std::tuple<long, long, long>> taken;
  for (int i = 0; i < 20000; ++i) {
    const auto coordinate = [&random] { return (static_cast<double>(random() % 4000) - 2000.0) / 1000.0; };
    const Eigen::Vector3d p(coordinate(), coordinate(), coordinate());
    const bool isNew = taken
                           .emplace(std::lround(std::floor(p.x() / 0.1)), std::lround(std::floor(p.y() / 0.1)),
                                    std::lround(std::floor(p.z() / 0.1)))
                           .second;
    ASSERT_EQ(thinner.accept(p, 0, 0.1, 10), isNew) << i;
  }
}

TEST(VoxelThinner, WindowPassed_AcceptsAgain) {
  VoxelThinner thinner;
  const Eigen::Vector3d p(1, 2, 3);
  EXPECT_TRUE(thinner.accept(p, 0, 0.1, 10));
  EXPECT_FALSE(thinner.accept(p, 9 * kNsPerSecond, 0.1, 10));
  EXPECT_TRUE(thinner.accept(p, 10 * kNsPerSecond, 0.1, 10));
}

TEST(VoxelThinner, NoWindow_ThinsEachScanByItself) {
  VoxelThinner thinner;
  EXPECT_TRUE(thinner.accept({0, 0, 0}, 5, 0.1, 0));
  EXPECT_FALSE(thinner.accept({0.01, 0, 0}, 5, 0.1, 0));
  EXPECT_TRUE(thinner.accept({0, 0, 0}, 6, 0.1, 0));
}

TEST(VoxelThinner, LongSurvey_MemoryIsBoundedByTheWindow) {
  VoxelThinner thinner;
  std::size_t largest = 0;
  for (int second = 0; second < 400; ++second) {
    for (int i = 0; i < 1000; ++i) thinner.accept({second + 0.1 * i, 0, 0}, second * kNsPerSecond, 0.1, 10);
    largest = std::max(largest, thinner.memory_bytes());
  }
  // Within 10 s the path touches 11 * 10 + 990 = 1100 voxels. The table grows at half load to at least four times what
  // is alive, so 8192 slots of 16 bytes suffice; without forgetting it would hold 5000 voxels in 16384 slots.
  EXPECT_LE(largest, std::size_t{8192} * 16);
}

}  // namespace
