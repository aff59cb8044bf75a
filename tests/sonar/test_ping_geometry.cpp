#include <gtest/gtest.h>

#include "s2s/sonar/ping_geometry.h"

namespace s2s::sonar {
namespace {

using obs::BearingModel;
constexpr double kDeg = M_PI / 180.0;

TEST(PingGeometry, PointAndCoordinates_AreInverse) {
  for (const auto model : {BearingModel::Azimuth, BearingModel::Cone})
    for (const double bearing : {-60.0, -5.0, 0.0, 33.0, 64.0})
      for (const double elevation : {-10.0, 0.0, 7.0}) {
        const auto c = sonarCoordinates(pointAt({4.0, bearing * kDeg, elevation * kDeg}, model), model);
        EXPECT_NEAR(c.range_m, 4.0, 1e-12);
        EXPECT_NEAR(c.bearing_rad, bearing * kDeg, 1e-12);
        EXPECT_NEAR(c.elevation_rad, elevation * kDeg, 1e-12);
      }
}

TEST(PingGeometry, BeamModels_DifferByTheKnownAngleAtTheFansEdge) {
  // At 60 degrees of bearing and 10 degrees of elevation the azimuth of a cone's return is 1.5 degrees larger.
  const auto p = pointAt({5, 60 * kDeg, 10 * kDeg}, BearingModel::Cone);
  EXPECT_NEAR(sonarCoordinates(p, BearingModel::Azimuth).bearing_rad / kDeg - 60, 1.5, 0.1);
}

TEST(PingGeometry, ConeBeyondItsEdge_EndsInThePlaneAcross) {
  const auto p = pointAt({5, 85 * kDeg, 20 * kDeg}, BearingModel::Cone);
  EXPECT_NEAR(p.norm(), 5, 1e-12);
  EXPECT_NEAR(p.x(), 0, 1e-6);
}

TEST(PingGeometry, BeamAt_InterpolatesRisingAndFallingTables) {
  PingGeometry rising, falling;
  rising.bearings_rad = {-0.3, -0.1, 0.2};
  falling.bearings_rad = {0.2, -0.1, -0.3};
  EXPECT_NEAR(rising.beamAt(0.05), 1.5, 1e-12);
  EXPECT_NEAR(falling.beamAt(0.05), 0.5, 1e-12);
  EXPECT_EQ(rising.beamAt(-0.3), 0);
  EXPECT_EQ(rising.beamAt(0.2), 2);
  EXPECT_EQ(rising.beamAt(0.21), -1);
  EXPECT_EQ(falling.beamAt(-0.31), -1);
  EXPECT_EQ(PingGeometry{}.beamAt(0), -1);
}

TEST(PingGeometry, Bins_AreCentredInTheirInterval) {
  PingGeometry g;
  g.rangeOffset_m = 0.5;
  g.rangeResolution_m = 0.1;
  g.rangeCount = 10;
  EXPECT_NEAR(g.range_m(0), 0.55, 1e-12);
  EXPECT_NEAR(g.binAt(g.range_m(7)), 7, 1e-12);
  EXPECT_NEAR(g.maxRange_m(), 1.5, 1e-12);
}

}  // namespace
}  // namespace s2s::sonar
