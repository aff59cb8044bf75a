#include <gtest/gtest.h>

#include <cmath>

#include "s2s/mapper/water_level.h"

namespace s2s::mapper {
namespace {

constexpr double kStep_s = 0.1;

TEST(WaterLevel, NothingAdded_IsUnknown) { EXPECT_FALSE(WaterLevel().known()); }

TEST(WaterLevel, HullInWaves_GivesTheMeanSurface) {
  WaterLevel level;
  for (int i = 0; i < 600; ++i)
    level.add(core::durationNs(i * kStep_s), 1.5 + 0.1 * std::sin(2 * M_PI * i * kStep_s / 3.0));
  // Sixty seconds hold twenty whole waves, so their mean cancels but for the first step's weight.
  EXPECT_NEAR(level.height_m(), 1.5, 0.005);
}

TEST(WaterLevel, SurfaceChanges_IsFollowedWithinAFewMemories) {
  WaterLevel level(10.0);
  for (int i = 0; i < 1000; ++i) level.add(core::durationNs(i * kStep_s), i < 500 ? 0.0 : 2.0);
  // Fifty seconds after the step, an exponential memory of ten has forgotten all but exp(-5) of it.
  EXPECT_NEAR(level.height_m(), 2.0, 2.0 * std::exp(-5.0) * 1.1);
}

}  // namespace
}  // namespace s2s::mapper
