#include <gtest/gtest.h>

#include "s2s/graph/scan_context.h"
#include "synthetic_survey.h"

using namespace s2s;
using namespace s2s::graph;
using graph::test::FixedRandom;
using graph::test::SyntheticTown;

namespace {

core::Isometry placeAt(double x, double yaw) { return core::isometryFromXyzYpr(x, 0, 0, yaw, 0.03, -0.05); }

}  // namespace

TEST(ScanContext, SamePlaceTurned_IsFoundWithItsHeading) {
  const SyntheticTown town(200, 80, 71);
  FixedRandom random(72);
  PlaceDatabase places({});
  const int kPlaces = 18;
  for (int n = 0; n < kPlaces; ++n) {
    const core::Isometry T = placeAt(10 * n, 0.2 * n);
    places.add(town.scan(T, 60, random), levelRotation(T));
  }
  int query = kPlaces;
  for (const double turn : {0.0, 1.0, M_PI, -2.0}) {
    const core::Isometry T = placeAt(100.5, 2.0 + turn);  // place 10, half a metre on
    places.add(town.scan(T, 60, random), levelRotation(T));
    const auto matches = places.find(query++, kPlaces, 1);
    ASSERT_EQ(matches.size(), 1U) << turn;
    EXPECT_EQ(matches[0].place, 10) << turn;
    // Half a sector is 3 degrees; one more sector for the half metre.
    EXPECT_NEAR(std::remainder(matches[0].yaw_rad - turn, 2 * M_PI), 0, 9 * M_PI / 180) << turn;
  }
}

TEST(ScanContext, OtherTown_DoesNotLookAlike) {
  FixedRandom random(73);
  ScanContextOptions options;
  PlaceDatabase places(options);
  const SyntheticTown here(200, 80, 71), there(200, 80, 74);
  for (int n = 0; n < 10; ++n) places.add(here.scan(placeAt(15 * n, 0), 60, random), Eigen::Matrix3d::Identity());
  places.add(there.scan(placeAt(60, 0), 60, random), Eigen::Matrix3d::Identity());
  EXPECT_TRUE(places.find(10, 10, 5).empty());
}

TEST(ScanContext, EmptyClouds_MatchNothing) {
  PlaceDatabase places({});
  places.add({}, Eigen::Matrix3d::Identity());
  places.add({}, Eigen::Matrix3d::Identity());
  EXPECT_TRUE(places.find(1, 1, 5).empty());
  EXPECT_TRUE(places.find(1, 0, 5).empty());
}

TEST(LevelRotation, KeepsRollAndPitchOnly) {
  const core::Isometry T = core::isometryFromXyzYpr(1, 2, 3, 2.5, 0.1, -0.2);
  const core::Isometry tilt = core::isometryFromXyzYpr(0, 0, 0, 0, 0.1, -0.2);
  EXPECT_TRUE(levelRotation(T).isApprox(tilt.linear(), 1e-12));
}
