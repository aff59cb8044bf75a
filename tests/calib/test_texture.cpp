#include <gtest/gtest.h>

#include <cmath>

#include "ideal_survey.h"
#include "world_texture.h"

namespace s2s::calib {
namespace {

using test::IdealSurveyOptions;

constexpr double kDegree = M_PI / 180;

/// Pings of a bed with texture, seen exactly as the measurement model says, with speckle of twice its contrast.
void addTexture(const IdealSurveyOptions& o, test::IdealSurvey& survey) {
  std::mt19937 random(9);
  std::normal_distribution<double> speckle(0, 0.6);
  const double half = 0.5 * survey.nominal[SonarId::Horizontal].aperture_rad;
  for (int n = 0; n < static_cast<int>(10 * o.duration_s); ++n) {
    const double t_s = 0.1 * n;
    const core::Isometry T = test::poseAt(o, t_s) * survey.truth[SonarId::Horizontal].T_vehicle_sonar;
    TexturePing ping;
    ping.time = test::kStart + core::durationNs(t_s + o.late_h_s);
    ping.firstRange_m = 1;
    ping.step_m = 0.03;
    for (int b = -48; b <= 48; ++b) {
      TexturePing::Beam beam;
      const double bearing = 0.015 * b;
      beam.bearing_rad = static_cast<float>(bearing);
      const double nearest = test::castRange(o, T, beam.bearing_rad, -half);
      if (nearest > 1.1) {
        beam.firstBin = static_cast<std::uint16_t>((nearest - ping.firstRange_m) / ping.step_m + 1);
        double elevation = -half;
        for (std::size_t bin = beam.firstBin; bin < beam.firstBin + 90U; ++bin) {
          elevation = test::elevationOf(o, T, ping.binRange_m(bin), beam.bearing_rad, elevation);
          if (!(std::abs(elevation) < half)) break;
          const Eigen::Vector3d p =
              T * sonar::pointAt({ping.binRange_m(bin), beam.bearing_rad, elevation}, obs::BearingModel::Azimuth);
          const double contrast = std::clamp(0.5 * test::textureAt(p.x(), p.y()) + speckle(random), -2.0, 2.0);
          beam.contrast.push_back(static_cast<std::int8_t>(kContrastScale * contrast));
        }
      }
      ping.beams.push_back(std::move(beam));
    }
    survey.evidence.texture.push_back(std::move(ping));
  }
}

CalibrationOptions quickOptions() {
  CalibrationOptions options;
  options.rounds = 8;
  options.maxEchoes = 20000;
  return options;
}

ParameterVerdict verdictOf(const CalibrationResult& result, int parameter) {
  return result.observability.parameters[static_cast<std::size_t>(parameter)];
}

TEST(Texture, TurnsOverRelief_TellsTheHorizontalSonarsHeadingPlaceAndTime) {
  IdealSurveyOptions o;
  o.duration_s = 60;
  o.error_h = core::isometryFromXyzYpr(0.05, -0.05, 0.05, 2 * kDegree, -2 * kDegree, 2 * kDegree);
  o.error_v = core::isometryFromXyzYpr(-0.05, 0.05, -0.05, -2 * kDegree, 2 * kDegree, -2 * kDegree);
  o.late_h_s = o.late_v_s = 0.03;
  auto survey = test::idealSurvey(o);
  addTexture(o, survey);
  const auto result = calibrate(survey.nominal, survey.evidence, quickOptions());
  EXPECT_GT(result.statistics.used[static_cast<std::size_t>(EvidenceKind::Texture)], 200u);
  const auto &nominal = survey.nominal[SonarId::Horizontal].T_vehicle_sonar,
             &truth = survey.truth[SonarId::Horizontal].T_vehicle_sonar;
  const Eigen::Vector3d place = truth.translation() - nominal.translation();
  const Eigen::Vector3d turn = core::logSo3(nominal.linear().transpose() * truth.linear());
  const WantedVector x = correctionsOf(result.state);
  // What a calibration has to reach: 1.5 cm, 0.15 deg, 3 ms.
  EXPECT_NEAR(x[kY], place.y(), 0.015);
  EXPECT_NEAR(x[kRotZ], turn.z(), 0.15 * kDegree);
  EXPECT_NEAR(x[kTime], 0.03, 0.003);
  for (const int i : {int{kY}, int{kRotZ}, int{kTime}})
    EXPECT_EQ(verdictOf(result, i).verdict, Verdict::Observable) << parameterName(i);
  // All else of this sonar as well as it claims.
  for (const auto& [i, value] :
       {std::pair<int, double>{kX, place.x()}, {kZ, place.z()}, {kRotX, turn.x()}, {kRotY, turn.y()}})
    EXPECT_NEAR(x[i], value, 3 * verdictOf(result, i).sigma) << parameterName(i);
}

TEST(Texture, StraightRunOverLevelBed_TellsTheHeadingButNeitherPlaceNorTime) {
  IdealSurveyOptions o;
  o.relief = o.turns = o.waves = false;
  o.duration_s = 40;
  o.error_h = core::isometryFromXyzYpr(0, 0, 0, 2 * kDegree, 0, 0);
  auto survey = test::idealSurvey(o);
  addTexture(o, survey);
  const auto result = calibrate(survey.nominal, survey.evidence, quickOptions());
  for (const int i : {int{kX}, int{kY}, int{kTime}})
    EXPECT_EQ(verdictOf(result, i).verdict, Verdict::Unobservable) << parameterName(i);
}

TEST(Texture, SpeckleWithoutTexture_IsAsIfThereWereNone) {
  IdealSurveyOptions o;
  o.duration_s = 40;
  auto survey = test::idealSurvey(o);
  addTexture(o, survey);
  std::mt19937 random(3);
  std::uniform_int_distribution<int> anything(-100, 100);
  for (auto& ping : survey.evidence.texture)
    for (auto& beam : ping.beams)
      for (auto& contrast : beam.contrast) contrast = static_cast<std::int8_t>(anything(random));
  const auto result = calibrate(survey.nominal, survey.evidence, quickOptions());
  const auto& statistics = result.statistics;
  const auto kind = static_cast<std::size_t>(EvidenceKind::Texture);
  EXPECT_LT(statistics.used[kind], 1 + statistics.leftOut[kind] / 200);
  for (const int i : {int{kY}, int{kRotZ}})
    EXPECT_NE(verdictOf(result, i).verdict, Verdict::Observable) << parameterName(i);
  // The bed's relief under waves and turns tells the time by itself; it has to be right, then: within 3 ms.
  EXPECT_NEAR(correctionsOf(result.state)[kTime], 0, 0.003);
}

/// A ping with a band of echo from 3 to 5 m, and noise elsewhere.
obs::CObservationImagingSonar bandPing() {
  obs::CObservationImagingSonar ping;
  ping.beamCount = 128;
  ping.rangeCount = 400;
  ping.rangeResolution_m = 0.02;
  for (std::uint32_t b = 0; b < ping.beamCount; ++b)
    ping.bearings_rad.push_back(0.015F * (static_cast<float>(b) - 63.5F));
  for (std::uint32_t bin = 0; bin < ping.rangeCount; ++bin)
    for (std::uint32_t b = 0; b < ping.beamCount; ++b) {
      const bool isBed = ping.binRange_m(bin) > 3 && ping.binRange_m(bin) < 5;
      const bool isBright = bin / 8 % 2 == 0;
      ping.samples.push_back(
          static_cast<std::uint8_t>(isBed ? (isBright ? 120 : 60) * (1 + 0.2 * ping.bearings_rad[b]) : 4));
    }
  return ping;
}

TEST(Texture, Ping_IsItsBandsContrastWhateverTheGainOfItsBeams) {
  const auto ping = bandPing();
  const TexturePing texture = texturePing(ping, 7, {});
  EXPECT_EQ(texture.time, 7);
  ASSERT_EQ(texture.beams.size(), 64u);
  const auto& beam = texture.beams[32];
  // The band is found in a mean over 0.6 m, so its ends are blurred by that.
  EXPECT_NEAR(texture.binRange_m(beam.firstBin), 3, 0.3);
  EXPECT_NEAR(texture.binRange_m(beam.firstBin + beam.contrast.size()), 5, 0.3);
  for (const auto& b : {texture.beams[6], texture.beams[32], texture.beams[57]})
    for (std::size_t k = 0; k < b.contrast.size(); ++k) {
      const double range = texture.binRange_m(b.firstBin + k);
      if (range < 3.4 || range > 4.6) continue;  // further out the mean holds what is not bed
      const bool isBright = static_cast<int>(range / 0.02) / 8 % 2 == 0;
      // 120 and 60 around their mean of 90: a third above and below; the window does not hold whole periods.
      EXPECT_NEAR(b.contrast[k] / kContrastScale, isBright ? 1.0 / 3 : -1.0 / 3, 0.08) << range;
    }
}

TEST(Texture, TinyPing_HasNone) {
  obs::CObservationImagingSonar ping;
  EXPECT_TRUE(texturePing(ping, 0, {}).beams.empty());
}

}  // namespace
}  // namespace s2s::calib
