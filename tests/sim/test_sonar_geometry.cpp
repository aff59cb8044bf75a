#include <gtest/gtest.h>

#include "s2s/sim/beam_pattern.h"
#include "s2s/sim/elevation_pattern.h"
#include "s2s/sim/sonar_geometry.h"
#include "s2s/sim/surface_multipath.h"
#include "sim_support.h"

using namespace s2s;
using namespace s2s::test;
using Eigen::Vector3d;

namespace {

constexpr double kDegree = M_PI / 180;

}  // namespace

TEST(SonarGeometry, OculusBeams_AreUniformInTheSine) {
  const sim::SonarOptions o;
  const sim::SonarGeometry geometry(o);
  const auto& b = geometry.bearings_rad();
  ASSERT_EQ(b.size(), 512u);
  EXPECT_NEAR(b.front(), -65 * kDegree, 1e-12);
  EXPECT_NEAR(b.back(), 65 * kDegree, 1e-12);
  const double step = std::sin(b[1]) - std::sin(b[0]);
  for (std::size_t i = 1; i < b.size(); ++i) EXPECT_NEAR(std::sin(b[i]) - std::sin(b[i - 1]), step, 1e-12);
  // The published spacing of the device: 0.20 degrees in the centre, 0.48 at the edge.
  EXPECT_NEAR((b[256] - b[255]) / kDegree, 0.20, 0.01);
  EXPECT_NEAR((b[511] - b[510]) / kDegree, 0.48, 0.01);
}

TEST(SonarGeometry, BlueViewBeams_AreUniformInAngle) {
  const sim::SonarGeometry geometry(sim::verticalSonarDefaults());
  const auto& b = geometry.bearings_rad();
  for (std::size_t i = 1; i < b.size(); ++i) EXPECT_NEAR(b[i] - b[i - 1], 45.0 / 255 * kDegree, 1e-12);
}

TEST(SonarGeometry, DirectionAndItsInverse_AgreeForBothModels) {
  for (const auto model : {obs::BearingModel::Azimuth, obs::BearingModel::Cone}) {
    sim::SonarOptions o;
    o.bearingModel = model;
    const sim::SonarGeometry g(o);
    for (double b = -1.1; b < 1.1; b += 0.1)
      for (double e = -0.3; e < 0.3; e += 0.07) {
        const Vector3d d = g.direction(b, e);
        EXPECT_NEAR(d.norm(), 1, 1e-12);
        EXPECT_NEAR((g.bearingElevation(d) - Eigen::Vector2d(b, e)).norm(), 0, 1e-12);
        const double measured = model == obs::BearingModel::Azimuth ? std::atan2(d.y(), d.x()) : std::asin(d.y());
        EXPECT_NEAR(measured, b, 1e-12);
      }
  }
}

TEST(SonarGeometry, ConeAndAzimuth_DifferByOneAndAHalfDegreesAtTheFansEdge) {
  sim::SonarOptions o;
  const Vector3d d = sim::SonarGeometry(o).direction(60 * kDegree, 10 * kDegree);
  o.bearingModel = obs::BearingModel::Cone;
  const double cone = sim::SonarGeometry(o).bearingElevation(d).x();
  EXPECT_NEAR((60 * kDegree - cone) / kDegree, 1.47, 0.05);  // asin(cos 10 sin 60) = 58.53 degrees
}

TEST(SonarGeometry, BeamPosition_InvertsTheBearings) {
  const sim::SonarGeometry g{sim::SonarOptions()};
  for (std::size_t i = 0; i < 512; i += 37)
    EXPECT_NEAR(g.beamPosition(g.bearings_rad()[i]), static_cast<double>(i), 1e-9);
}

TEST(SonarGeometry, WrongSoundSpeed_TurnsTheBeamsBySnell) {
  sim::SonarOptions o;
  o.soundSpeed_mps = 1450;
  o.soundSpeedAssumed_mps = 1500;
  const sim::SonarGeometry g(o);
  const double b = g.trueBearing_rad(50 * kDegree);
  EXPECT_NEAR(std::sin(b) / 1450, std::sin(50 * kDegree) / 1500, 1e-15);
  EXPECT_NEAR(g.formedBearing_rad(b), 50 * kDegree, 1e-12);
}

TEST(BeamPattern, SideLobes_AreThoseOfTheShading) {
  const auto highestSideLobe_db = [](double taper, double from) {
    double peak = 0;
    for (double x = from; x < 8; x += 1e-3) peak = std::max(peak, std::abs(sim::arrayPattern(x, taper)));
    return 20 * std::log10(peak);
  };
  EXPECT_NEAR(highestSideLobe_db(1, 1), -13.26, 0.02);   // uniform line array (Urick 1983, ch. 3)
  EXPECT_NEAR(highestSideLobe_db(0.54, 2), -42.7, 0.3);  // Hamming (Harris 1978, table I: -43 dB)
  EXPECT_LT(highestSideLobe_db(0.75, 1.3), -20);         // the default: about -24 dB as measured on such devices
  EXPECT_NEAR(sim::halfPowerPoint(1), 0.4429, 1e-3);     // sinc^2 = 1/2
}

TEST(ElevationPattern, Edges_AreAtTheAperture) {
  sim::SonarOptions o;
  for (const auto p : {sim::ElevationPattern::Sinc, sim::ElevationPattern::Shaped}) {
    o.elevationPattern = p;
    EXPECT_NEAR(sim::elevationPattern(o, 0), 1, 1e-12);
    EXPECT_NEAR(sim::elevationPattern(o, 10 * kDegree), 0.5, 1e-9);
  }
  o.elevationPattern = sim::ElevationPattern::Rectangle;
  EXPECT_EQ(sim::elevationPattern(o, 9.99 * kDegree), 1);
  EXPECT_EQ(sim::elevationPattern(o, 10.01 * kDegree), 0);
  o.elevationPattern = sim::ElevationPattern::Shaped;
  for (double e = 15; e < 70; e += 0.5)
    EXPECT_LE(sim::elevationPattern(o, e * kDegree), std::pow(10, 0.1 * o.elevationSideLobe_db) + 1e-3);
}

TEST(SurfaceMultipath, Ghosts_LieWhereTheImageMethodPutsThem) {
  sim::SonarOptions o = idealSonar();
  o.elevationPattern = sim::ElevationPattern::Sinc;
  o.aperture_rad = 80 * kDegree;
  o.surfaceLoss_db = 0;
  const sim::SonarGeometry g(o);
  const core::Isometry T_world_sensor = core::isometryFromXyzYpr(0, 0, -1, 0, 0, 0);  // 1 m deep, level
  const Vector3d target(6, 0, -2);
  sim::GhostEcho ghosts[3];
  sim::SurfaceMultipath(o, g).find(T_world_sensor, target, {0, std::atan2(-1, 6)}, ghosts);
  const double direct = std::hypot(6, 1), over = std::hypot(6, 3);  // the image of the target is 2 m above the water
  EXPECT_NEAR(ghosts[0].range_m, 0.5 * (direct + over), 1e-12);
  EXPECT_NEAR(ghosts[1].range_m, 0.5 * (direct + over), 1e-12);
  EXPECT_NEAR(ghosts[2].range_m, over, 1e-12);
  const double gd = sim::elevationPattern(o, std::atan2(1, 6)), go = sim::elevationPattern(o, std::atan2(3, 6));
  const double spread = direct * direct / (over * over);
  EXPECT_NEAR(ghosts[0].gain, gd * go * spread, 1e-9);
  EXPECT_NEAR(ghosts[2].gain, go * go * spread * spread, 1e-9);
}
