#include <gtest/gtest.h>

#include <cmath>

#include "ideal_survey.h"

namespace s2s::calib {
namespace {

using test::IdealSurveyOptions;

constexpr double kDegree = M_PI / 180;

/// Pings of a bed through an aperture that is 0.7 deg wider on both sides than the device says and falls off as a real
/// one does, with speckle, noise that rises with range and an echo that does, too.
void addProfiles(const IdealSurveyOptions& o, test::IdealSurvey& survey) {
  std::mt19937 random(9);
  std::exponential_distribution<double> speckle(1);
  const double half = 0.5 * survey.nominal[SonarId::Horizontal].aperture_rad + 0.7 * kDegree;
  for (double t_s = 0; t_s < o.duration_s; t_s += 0.2) {
    const core::Isometry T = test::poseAt(o, t_s) * survey.truth[SonarId::Horizontal].T_vehicle_sonar;
    AperturePing ping;
    ping.time = test::kStart + core::durationNs(t_s + o.late_h_s);
    ping.firstRange_m = 1.01;
    ping.step_m = 0.02;
    for (int b = -10; b <= 10; ++b) {
      AperturePing::Strip strip;
      strip.bearing_rad = 0.05F * static_cast<float>(b);
      const auto bearing = static_cast<double>(strip.bearing_rad);
      double elevation = -2 * half;
      const double nearest_m = test::castRange(o, T, bearing, elevation);
      for (int bin = 0; bin < 400; ++bin) {
        const double r = ping.binRange_m(bin);
        double echo = 0;
        if (nearest_m > 0 && r > nearest_m && elevation < 2 * half) {
          elevation = test::elevationOf(o, T, r, bearing, elevation);
          echo = 9000 * (1 + 0.1 * (r - 4)) / (1 + std::pow(elevation / half, 16));
        }
        strip.strength.push_back(static_cast<std::uint16_t>(std::min(65535.0, (echo + 25 * r * r) * speckle(random))));
      }
      ping.strips.push_back(std::move(strip));
    }
    survey.evidence.aperture.push_back(std::move(ping));
  }
}

/// A survey of a vessel whose sonars' places and ranges are known: its turns are not.
struct TurnedSurvey {
  IdealSurveyOptions options;
  test::IdealSurvey survey;
  CalibrationOptions calibration;
  TurnedSurvey() {
    options.duration_s = 60;
    options.error_h = core::isometryFromXyzYpr(0, 0, 0, 0, -2 * kDegree, 0);
    survey = test::idealSurvey(options);
    for (PingEchoes& ping : survey.evidence.pings)  // the horizontal sonar's far edges are not used as a rule
      ping.echoes.erase(std::remove_if(ping.echoes.begin(), ping.echoes.end(),
                                       [](const Echo& e) { return e.kind == EchoKind::FarEdge; }),
                        ping.echoes.end());
    calibration.rounds = 8;
    calibration.maxEchoes = 20000;
    calibration.positionSigma_m = calibration.rangeSigma_m = calibration.rangeBearingSigma_m = 0.002;
    calibration.rangeScaleSigma = 0.0005;
  }
};

TEST(Aperture, BothEndsOnAKnownBed_TellTheTurnAcrossThePlane) {
  TurnedSurvey turned;
  addProfiles(turned.options, turned.survey);
  const auto result = calibrate(turned.survey.nominal, turned.survey.evidence, turned.calibration);
  EXPECT_GT(result.statistics.used[static_cast<std::size_t>(EvidenceKind::Aperture)], 50u);
  const TurnedSurvey without;
  const auto resultWithout = calibrate(without.survey.nominal, without.survey.evidence, without.calibration);
  const double sigma = result.observability.parameters[kRotY].sigma;
  EXPECT_LT(sigma, 0.5 * resultWithout.observability.parameters[kRotY].sigma);
  EXPECT_NEAR(correctionsOf(result.state)[kRotY], -2 * kDegree, 3 * sigma);
  // What a calibration has to reach: 0.15 deg.
  EXPECT_NEAR(correctionsOf(result.state)[kRotY], -2 * kDegree, 0.15 * kDegree);
  // A profile is blurred by its sector and by four bins of range: some tenths of a degree.
  EXPECT_NEAR(result.state[SonarId::Horizontal].correction[kWidth], 0.7 * kDegree, 0.3 * kDegree);
}

TEST(Aperture, Ping_IsTheMeanSquareOfItsBeams) {
  obs::CObservationImagingSonar ping;
  ping.beamCount = 16;
  ping.rangeCount = 20;
  ping.rangeResolution_m = 0.02;
  ping.bytesPerSample = 2;
  for (std::uint32_t b = 0; b < ping.beamCount; ++b)
    ping.bearings_rad.push_back(0.01F * (static_cast<float>(b) - 7.5F));
  for (std::uint32_t bin = 0; bin < ping.rangeCount; ++bin)
    for (std::uint32_t b = 0; b < ping.beamCount; ++b)
      for (const std::uint32_t byte : {0U, b % 2 == 0 ? 100U : 200U})
        ping.samples.push_back(static_cast<std::uint8_t>(byte));
  ApertureOptions options;
  options.beamStep = 8;
  options.beamsAveraged = 4;
  const AperturePing profile = aperturePing(ping, 7, options);
  EXPECT_EQ(profile.time, 7);
  ASSERT_EQ(profile.strips.size(), 2u);
  EXPECT_NEAR(profile.binRange_m(3), ping.binRange_m(3), 1e-12);
  EXPECT_NEAR(static_cast<double>(profile.strips[0].bearing_rad), -0.06, 1e-6);
  // Samples count in 255ths of the largest one, whatever their size in bytes; the rest is rounding.
  const double scale = 255.0 * 256 / 65535;
  EXPECT_NEAR(profile.strips[1].strength[5], scale * scale * (100.0 * 100 + 200 * 200) / 2, 1);
  options.maxBearing_rad = 0.01;
  EXPECT_TRUE(aperturePing(ping, 7, options).strips.empty());
}

}  // namespace
}  // namespace s2s::calib
