#include <ceres/jet.h>
#include <gtest/gtest.h>

#include "s2s/calib/surface_residual.h"
#include "s2s/sonar/ping_geometry.h"
#include "s2s/sonar/sound_speed.h"

namespace s2s::calib {
namespace {

SonarState sonarState(obs::BearingModel model) {
  SonarState sonar;
  sonar.T_vehicle_sonar = core::isometryFromXyzYpr(-1.1, 0.2, -0.45, 0.1, 0.7, 0.05);
  sonar.aperture_rad = 0.35;
  sonar.deviceSoundSpeed_mps = 1480;
  sonar.model = model;
  return sonar;
}

PingMotion pingMotion() {
  PingMotion motion;
  motion.T_map_vehicle = core::isometryFromXyzYpr(10, 20, 0.1, 1.0, 0.03, -0.02);
  motion.velocity_mps = {1.2, 0.1, -0.05};
  motion.rate_radps = {0.1, -0.08, 0.3};
  return motion;
}

class EchoPointModels : public ::testing::TestWithParam<obs::BearingModel> {};

TEST_P(EchoPointModels, NoCorrection_IsTheSonarsOwnModelThroughThePoses) {
  const SonarState sonar = sonarState(GetParam());
  const PingMotion motion = pingMotion();
  const Echo echo{0.4F, 5.0F, EchoKind::NearEdge, -1.0F};
  const SonarVector zero{};
  const Eigen::Vector3d expected =
      motion.T_map_vehicle *
      (sonar.T_vehicle_sonar * sonar::pointAt({5.0, echo.bearing_rad, -0.5 * sonar.aperture_rad}, GetParam()));
  EXPECT_LT((echoPoint<double>(echo, sonar, motion, zero.data(), 1480) - expected).norm(), 1e-9);
}

TEST_P(EchoPointModels, Corrections_AreThoseOfTheCorrectedSonar) {
  SonarState sonar = sonarState(GetParam());
  sonar.correction = {0.03, -0.02, 0.05, 0.02, -0.03, 0.01, 0, 0, 0, 0, 0, 0.04, 0.002, 0, 0};
  const PingMotion motion = pingMotion();
  const Echo echo{-0.3F, 4.0F, EchoKind::Middle, 0.5F};
  const double ratio = 1495.0 / 1480;
  const double range_m = 4.0 * ratio - 0.04 - 0.002 * 4.0;
  const double bearing = sonar::trueBearing_rad(echo.bearing_rad, ratio);
  const Eigen::Vector3d expected =
      motion.T_map_vehicle *
      (sonar.corrected() * sonar::pointAt({range_m, bearing, 0.25 * sonar.aperture_rad}, GetParam()));
  EXPECT_LT((echoPoint<double>(echo, sonar, motion, sonar.correction.data(), 1495) - expected).norm(), 1e-9);
}

TEST_P(EchoPointModels, Derivatives_AgreeWithDifferences) {
  SonarState sonar = sonarState(GetParam());
  sonar.correction = {0.01, 0.02, -0.03, 0.02, 0.01, -0.02, 0.004, 0.01, 0.02, 0.01, 0.02, 0.01, 0.002, 0.01, 0.02};
  const PingMotion motion = pingMotion();
  for (const EchoKind kind : {EchoKind::NearEdge, EchoKind::FarEdge, EchoKind::Middle}) {
    SeabedResidual residual{
        {0.4F, 5.0F, kind, kind == EchoKind::FarEdge ? 1.0F : -1.0F}, &sonar, &motion, {9.0, 20.0}, 0.5, 20};
    const double c = 1470, h[4] = {-3, -3.1, -2.9, -3.3};
    using Jet = ceres::Jet<double, kSonarParameters + 1>;
    std::array<Jet, kSonarParameters> x;
    for (int i = 0; i < kSonarParameters; ++i)
      x[static_cast<std::size_t>(i)] = Jet(sonar.correction[static_cast<std::size_t>(i)], i);
    const Jet speed(c, kSonarParameters), h0(h[0]), h1(h[1]), h2(h[2]), h3(h[3]);
    Jet value;
    residual(x.data(), &speed, &h0, &h1, &h2, &h3, &value);
    const auto at = [&](SonarVector p, double soundSpeed) {
      double r = 0;
      residual(p.data(), &soundSpeed, &h[0], &h[1], &h[2], &h[3], &r);
      return r;
    };
    for (int i = 0; i < kSonarParameters; ++i) {
      SonarVector up = sonar.correction, down = up;
      up[static_cast<std::size_t>(i)] += 1e-5;
      down[static_cast<std::size_t>(i)] -= 1e-5;
      // Second differences of this size: third derivatives (of some hundreds) times the step squared.
      EXPECT_NEAR(value.v[i], (at(up, c) - at(down, c)) / 2e-5, 1e-5 * (1 + std::abs(value.v[i]))) << i;
    }
    EXPECT_NEAR(value.v[kSonarParameters], (at(sonar.correction, c + 0.01) - at(sonar.correction, c - 0.01)) / 0.02,
                1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(Both, EchoPointModels, ::testing::Values(obs::BearingModel::Azimuth, obs::BearingModel::Cone));

TEST(BandResidual, LeaningPlaneOverLevelBed_FitsAsAWholeThoughItsPointsDoNot) {
  SonarState sonar = sonarState(obs::BearingModel::Azimuth);
  sonar.T_vehicle_sonar = core::isometryFromXyzYpr(0, 0, -0.5, 0, M_PI / 4, 95 * M_PI / 180);
  const PingMotion motion;
  const double bearing = 0.1, bed = -3, c = 1480;
  double mean = 0;  // range over the aperture, as a band's centre tells it
  constexpr int kRays = 201;
  for (int k = 0; k < kRays; ++k) {
    const double elevation = (static_cast<double>(k) / (kRays - 1) - 0.5) * sonar.aperture_rad;
    const Eigen::Vector3d ray = sonar.T_vehicle_sonar.linear() * sonar::pointAt({1, bearing, elevation}, sonar.model);
    mean += (bed - sonar.T_vehicle_sonar.translation().z()) / ray.z() / kRays;
  }
  const Echo echo{static_cast<float>(bearing), static_cast<float>(mean), EchoKind::Band,
                  static_cast<float>(1 / std::sqrt(3.0))};
  const SeabedResidual one{echo, &sonar, &motion, {0, 0}, 0.5, 1};
  double point = 0, band = 0;
  one(sonar.correction.data(), &c, &bed, &bed, &bed, &bed, &point);
  BandResidual{one, {0, 0}}(sonar.correction.data(), &c, &bed, &bed, &bed, &bed, &bed, &bed, &bed, &bed, &band);
  EXPECT_LT(std::abs(band), 0.002);  // quadrature of two points, and the mean of ranges for that of heights
  EXPECT_GT(std::abs(point),
            0.015);  // 5 deg of lean at a tenth of a radian beside the middle, 3.5 m away: 3 cm less bend
}

}  // namespace
}  // namespace s2s::calib
