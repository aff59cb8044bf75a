#include <gtest/gtest.h>

#include "leading_edge_scene.h"
#include "s2s/map/free_space.h"

namespace {

using namespace s2s::map;
using namespace s2s::test;
using s2s::core::Isometry;
using s2s::core::isometryFromXyzYpr;

constexpr double kSeabed_m = -3.4, kMargin_m = 0.15;

/// Pings of the horizontal sonar over a level seabed, `step_m` apart.
FreeSpace pingsOver(int count, double step_m) {
  LeadingEdgeScene scene;
  scene.add(LeadingEdgeScene::seabed(kSeabed_m));
  FreeSpace space;
  for (int i = 0; i < count; ++i) {
    const Isometry T_map_vehicle = isometryFromXyzYpr(step_m * i, 0, 0, 0, 0, 0);
    const LineScan line = scene.ping(T_map_vehicle, horizontalMount(), kHorizontalHalfFan, 256);
    StoredLineScan scan;
    scan.pose.layer = Layer::LineHorizontal;
    scan.T_vehicle_sonar = horizontalMount();
    scan.verticalAperture_rad = static_cast<float>(line.verticalAperture_rad);
    for (const LineReturn& r : line.returns) {
      PackedReturn packed;
      packed.range_m = r.range_m;
      packed.bearing_rad = r.bearing_rad;
      packed.rangeSigmaCode = encodeSigma(r.sigma_m);
      scan.returns.push_back(packed);
    }
    space.add(scan, T_map_vehicle * horizontalMount());
  }
  return space;
}

TEST(FreeSpace, OpenWater_IsFreeWhereEnoughPingsSayIt) {
  const FreeSpace space = pingsOver(10, 0.35);
  // Straight in the middle of the aperture, halfway down: seen by several pings.
  EXPECT_TRUE(space.isFree({3.0, 0, -1.9}, kMargin_m, 3));
  EXPECT_FALSE(space.isFree({3.0, 0, -1.9}, kMargin_m, 10));
}

TEST(FreeSpace, SeabedAndBelow_IsNeverFree) {
  const FreeSpace space = pingsOver(10, 0.35);
  for (double x = 1; x < 8; x += 0.2)
    for (double y = -3; y <= 3; y += 0.5)
      for (double z = kSeabed_m; z > -5; z -= 0.2) EXPECT_FALSE(space.isFree({x, y, z}, kMargin_m, 1)) << x << ' ' << z;
}

TEST(FreeSpace, OutsideEveryAperture_IsNotFree) {
  const FreeSpace space = pingsOver(10, 0.35);
  EXPECT_FALSE(space.isFree({6.0, 0, -0.4}, kMargin_m, 1));   // straight ahead: 45 degrees above the imaging plane
  EXPECT_FALSE(space.isFree({-2.0, 0, -1.9}, kMargin_m, 1));  // behind
  EXPECT_FALSE(space.isFree({500, 0, -1.9}, kMargin_m, 1));
}

TEST(FreeSpace, PingsFromOnePlace_CountAsOne) {
  EXPECT_EQ(pingsOver(20, 0.01).pingCount(), 1u);
  EXPECT_EQ(pingsOver(20, 0.31).pingCount(), 20u);
}

}  // namespace
