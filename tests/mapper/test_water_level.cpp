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
    level.add(core::durationNs(i * kStep_s), {0, 0, 1.5 + 0.1 * std::sin(2 * M_PI * i * kStep_s / 3.0)});
  // A memory of 20 s passes 1 / (2 pi 20 / 3) of a wave of 3 s.
  EXPECT_NEAR(level.height_m(Eigen::Vector3d::UnitZ()), 1.5, 0.005);
}

TEST(WaterLevel, SurfaceChanges_IsFollowedWithinAFewMemories) {
  WaterLevel level(10.0);
  for (int i = 0; i < 1000; ++i) level.add(core::durationNs(i * kStep_s), {0, 0, i < 500 ? 0.0 : 2.0});
  // Fifty seconds after the step, an exponential memory of ten has forgotten all but exp(-5) of it.
  EXPECT_NEAR(level.height_m(Eigen::Vector3d::UnitZ()), 2.0, 2.0 * std::exp(-5.0) * 1.1);
}

TEST(WaterLevel, FrameIsTilted_HeightDoesNotLagBehindTheVessel) {
  // Half a degree, known only after half of the way, at 1.2 m/s: along the frame's z the vessel climbs 10 mm a second.
  const double tilt = 0.5 * M_PI / 180;
  const Eigen::Vector3d ahead(std::cos(tilt), 0, std::sin(tilt)), up(-std::sin(tilt), 0, std::cos(tilt));
  WaterLevel level;
  for (int i = 0; i < 1000; ++i) level.add(core::durationNs(i * kStep_s), 1.2 * kStep_s * i * ahead + 0.3 * up);
  EXPECT_NEAR(level.height_m(up), 0.3, 1e-9);  // exact: every place has this height along the true up
}

}  // namespace
}  // namespace s2s::mapper
