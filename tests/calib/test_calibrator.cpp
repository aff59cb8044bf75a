#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "ideal_survey.h"
#include "s2s/calib/calibration_report.h"
#include "s2s/core/error.h"

namespace s2s::calib {
namespace {

using test::IdealSurveyOptions;

constexpr double kDegree = M_PI / 180;

IdealSurveyOptions wrongMountings() {
  IdealSurveyOptions options;
  options.error_h = core::isometryFromXyzYpr(0.05, -0.05, 0.05, 2 * kDegree, -2 * kDegree, 2 * kDegree);
  options.error_v = core::isometryFromXyzYpr(-0.05, 0.05, -0.05, -2 * kDegree, 2 * kDegree, -2 * kDegree);
  options.late_h_s = options.late_v_s = 0.03;
  return options;
}

/// True corrections in the order of the wanted parameters.
WantedVector trueCorrections(const test::IdealSurvey& survey, const IdealSurveyOptions& options) {
  WantedVector x = WantedVector::Zero();
  for (const SonarId id : kSonars) {
    const int at = static_cast<int>(id) * kWantedSonarParameters;
    const auto &nominal = survey.nominal[id].T_vehicle_sonar, &truth = survey.truth[id].T_vehicle_sonar;
    x.segment<3>(at) = truth.translation() - nominal.translation();
    x.segment<3>(at + kRotX) = core::logSo3(nominal.linear().transpose() * truth.linear());
    x[at + kTime] = id == SonarId::Horizontal ? options.late_h_s : options.late_v_s;
  }
  return x;
}

double toleranceOf(int parameter) {  // what a calibration has to reach: 1.5 cm, 0.15 deg, 3 ms
  switch (kindOf(parameter)) {
    case ParameterKind::Position:
      return 0.015;
    case ParameterKind::Rotation:
      return 0.15 * kDegree;
    case ParameterKind::Time:
      return 0.003;
    case ParameterKind::SoundSpeed:
      break;
  }
  return 5;
}

CalibrationOptions quickOptions() {
  CalibrationOptions options;
  options.rounds = 8;
  options.maxEchoes = 20000;
  return options;
}

/// A survey with everything that is wrong with it, and what was made of it; once for all tests.
struct Found {
  IdealSurveyOptions options = wrongMountings();
  test::IdealSurvey survey;
  CalibrationResult result;
  Found() : survey(test::idealSurvey(options)) { result = calibrate(survey.nominal, survey.evidence, quickOptions()); }
};

const Found& found() {
  static const Found kFound;
  return kFound;
}

TEST(Calibrator, TurnsOverRelief_ComesWithinItsSigmas) {
  const WantedVector x = correctionsOf(found().result.state), truth = trueCorrections(found().survey, found().options);
  for (int i = 0; i < kWanted; ++i) {
    const auto& verdict = found().result.observability.parameters[static_cast<std::size_t>(i)];
    if (verdict.verdict == Verdict::Unobservable) continue;
    EXPECT_NEAR(x[i], truth[i], 3 * verdict.sigma) << parameterName(i);
  }
}

TEST(Calibrator, TurnsOverRelief_WhatItClaimsIsWithinTheLimits) {
  const WantedVector x = correctionsOf(found().result.state), truth = trueCorrections(found().survey, found().options);
  for (int i = 0; i < kWanted; ++i) {
    const auto& verdict = found().result.observability.parameters[static_cast<std::size_t>(i)];
    if (verdict.verdict != Verdict::Observable) continue;
    EXPECT_NEAR(x[i], truth[i], toleranceOf(i)) << parameterName(i);
  }
  // The vertical sonar's turn in its plane and its time are what such a survey tells best.
  for (const int i : {kRotZ + kWantedSonarParameters, kTime + kWantedSonarParameters})
    EXPECT_NEAR(x[i], truth[i], toleranceOf(i)) << parameterName(i);
}

TEST(Calibrator, OneThread_GivesTheSameBits) {
  const auto again = calibrate(found().survey.nominal, found().survey.evidence, quickOptions());
  EXPECT_EQ(correctionsOf(again.state), correctionsOf(found().result.state));
  EXPECT_EQ(again.observability.parameters[kTime].sigma, found().result.observability.parameters[kTime].sigma);
}

TEST(Calibrator, CommonHeight_IsNeverClaimed) {
  // A seabed of unknown height rises with both sonars: whatever the survey, this cannot be told.
  for (const int z : {kZ + 0, kZ + kWantedSonarParameters})
    EXPECT_EQ(found().result.observability.parameters[static_cast<std::size_t>(z)].verdict, Verdict::Unobservable);
}

constexpr std::array<int, 7> kUntoldByStraightRun = {kX,
                                                     kY,
                                                     kTime,
                                                     kX + kWantedSonarParameters,
                                                     kY + kWantedSonarParameters,
                                                     kRotY + kWantedSonarParameters,
                                                     kTime + kWantedSonarParameters};

CalibrationResult straightRun(double noise_m) {
  IdealSurveyOptions options;
  options.relief = options.turns = options.waves = false;
  options.duration_s = 60;
  options.noise_m = noise_m;
  const auto survey = test::idealSurvey(options);
  return calibrate(survey.nominal, survey.evidence, quickOptions());
}

TEST(Calibrator, StraightRunOverLevelBed_ClaimsNoPlaceAndNoHeading) {
  const auto result = straightRun(0.01);
  for (const int i : kUntoldByStraightRun) {
    EXPECT_EQ(result.observability.parameters[static_cast<std::size_t>(i)].verdict, Verdict::Unobservable)
        << parameterName(i);
    // The noise of the echoes stays in the bed fitted to them and passes for relief, so what nothing tells still moves
    // (y of the horizontal sonar by 0.7), but not beyond what was known before. The next test has no such noise.
    EXPECT_LT(std::abs(correctionsOf(result.state)[i]), priorSigmaOf(i, {})) << parameterName(i);
  }
}

TEST(Calibrator, StraightRunOverLevelBedWithoutNoise_MovesNoneOfThem) {
  const auto result = straightRun(0.0005);
  // Directions known worse than half of the prior stay; what lies along others by the rest is to be less than that.
  for (const int i : kUntoldByStraightRun)
    EXPECT_LT(std::abs(correctionsOf(result.state)[i]), 0.3 * priorSigmaOf(i, {})) << parameterName(i);
}

TEST(Calibrator, WallThatTheLidarSees_TellsTheHorizontalSonarsPlaceAcrossIt) {
  IdealSurveyOptions options = wrongMountings();
  options.wall_y_m = 4.5;
  const auto survey = test::idealSurvey(options);
  const auto result = calibrate(survey.nominal, survey.evidence, quickOptions());
  EXPECT_GT(result.statistics.used[static_cast<std::size_t>(EvidenceKind::WallEdge)], 30u);
  const auto& with = result.observability.parameters;
  const auto& without = found().result.observability.parameters;
  const WantedVector x = correctionsOf(result.state), truth = trueCorrections(survey, options);
  for (const int i : {int{kY}, int{kRotZ}}) {
    EXPECT_LT(with[static_cast<std::size_t>(i)].sigma, without[static_cast<std::size_t>(i)].sigma) << parameterName(i);
    EXPECT_NEAR(x[i], truth[i], 3 * with[static_cast<std::size_t>(i)].sigma) << parameterName(i);
  }
}

TEST(Calibrator, TooFewEchoes_SaysSo) {
  auto survey = test::idealSurvey({});
  survey.evidence.pings.resize(5);
  EXPECT_THROW(calibrate(survey.nominal, survey.evidence, {}), core::InputError);
  EXPECT_THROW(calibrate(survey.nominal, {}, {}), core::InputError);
}

TEST(Calibrator, Report_KeepsTheIniAndTellsEveryParameter) {
  const CalibrationResult& result = found().result;
  const std::string text = reportText(result);
  for (int i = 0; i < kWanted; ++i) EXPECT_THAT(text, ::testing::HasSubstr(parameterName(i)));
  const std::string ini = calibratedIni("# mine\n[mapper]\nlabel_imu = IMU # keep\n", result);
  EXPECT_THAT(ini, ::testing::StartsWith("# mine\n[mapper]\nlabel_imu = IMU # keep\n"));
  EXPECT_THAT(ini, ::testing::HasSubstr("pose_sonar_vertical = "));
}

}  // namespace
}  // namespace s2s::calib
