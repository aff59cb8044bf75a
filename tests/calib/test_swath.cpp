#include <gtest/gtest.h>

#include <random>

#include "s2s/calib/echo_table.h"
#include "s2s/calib/swath.h"

namespace s2s::calib {
namespace {

/// A ping with a band of echoes between two ranges, under speckle, on a floor that rises with range.
obs::CObservationImagingSonar bandPing(double near_m, double far_m) {
  obs::CObservationImagingSonar ping;
  ping.beamCount = 96;
  ping.rangeCount = 500;
  ping.rangeResolution_m = 0.02;
  ping.verticalAperture_rad = 20 * M_PI / 180;
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (std::uint32_t b = 0; b < ping.beamCount; ++b) ping.bearings_rad.push_back(0.01F * (static_cast<float>(b) - 48));
  for (std::uint32_t bin = 0; bin < ping.rangeCount; ++bin)
    for (std::uint32_t b = 0; b < ping.beamCount; ++b) {
      const double r = ping.binRange_m(bin);
      // The outer eighths of the fan see nothing, so that every row has a floor.
      const bool echo = b >= 12 && b < 84 && r > near_m && r < far_m;
      const double power = (echo ? 40.0 : 0.0) + 1.0 * (0.5 + 0.1 * r);
      const double amplitude = std::hypot(normal(random), normal(random)) * std::sqrt(power);
      ping.samples.push_back(static_cast<std::uint8_t>(std::min(255.0, 40 * std::sqrt(amplitude))));
    }
  return ping;
}

TEST(Swath, Band_BothEdgesAreFound) {
  const auto swaths = findSwaths(bandPing(3.5, 5.5), {});
  double near = 0, far = 0, count = 0;
  for (const Swath& s : swaths) {
    if (std::abs(s.bearing_rad) > 0.3) continue;
    near += s.near_m, far += s.far_m, ++count;
  }
  ASSERT_GE(count, 6);
  // Speckle of a few looks moves single edges by a bin or two of 2 cm; the mean over the beams by less.
  EXPECT_NEAR(near / count, 3.5, 0.03);
  EXPECT_NEAR(far / count, 5.5, 0.03);
}

TEST(Swath, NoiseOnly_FindsAlmostNothing) { EXPECT_LE(findSwaths(bandPing(20, 21), {}).size(), 2u); }

TEST(Swath, EmptyPing_IsNoFault) { EXPECT_TRUE(findSwaths({}, {}).empty()); }

TEST(EchoTable, PlaneAcrossTheVertical_GivesEdges) {
  const core::Isometry pitched = core::isometryFromXyzYpr(0, 0, 0, 0, M_PI / 4, 0);
  const auto echoes = echoesOf({{0.1, 3, 5, 4, 1}}, pitched, 0.35, 10);
  ASSERT_EQ(echoes.size(), 2u);
  EXPECT_EQ(echoes[0].kind, EchoKind::NearEdge);
  EXPECT_EQ(echoes[0].elevationShare, -1);  // pitched down, the sonar's -z looks further down
  EXPECT_EQ(echoes[1].kind, EchoKind::FarEdge);
  EXPECT_EQ(echoes[1].elevationShare, 1);
}

TEST(EchoTable, UpsideDown_LowerEdgeIsTheOtherOne) {
  const core::Isometry flipped = core::isometryFromXyzYpr(0, 0, 0, 0, M_PI / 4, M_PI);
  EXPECT_EQ(echoesOf({{0.1, 3, 5, 4, 1}}, flipped, 0.35, 10).front().elevationShare, 1);
}

TEST(EchoTable, BandCutByTheLastBin_HasNoFarEdge) {
  const core::Isometry pitched = core::isometryFromXyzYpr(0, 0, 0, 0, M_PI / 4, 0);
  EXPECT_EQ(echoesOf({{0.1, 3, 9.95, 6, 1}}, pitched, 0.35, 10).size(), 1u);
}

TEST(EchoTable, UprightPlane_GivesOneBandEach) {
  const core::Isometry upright = core::isometryFromXyzYpr(0, 0, 0, 0, M_PI / 4, M_PI / 2);
  const auto echoes = echoesOf({{0.1, 3.9, 4.1, 4, 1}, {0.2, 3.9, 4.1, 4, 1}}, upright, 0.35, 10);
  ASSERT_EQ(echoes.size(), 2u);
  for (const Echo& echo : echoes) {
    EXPECT_EQ(echo.kind, EchoKind::Band);
    EXPECT_FLOAT_EQ(echo.elevationShare, static_cast<float>(1 / std::sqrt(3.0)));  // Gauss' two points
  }
}

}  // namespace
}  // namespace s2s::calib
