#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
  Found() : survey(test::idealSurvey(options)) {
    result = calibrate(survey.nominal, survey.pings, survey.trajectory, quickOptions());
  }
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
  const auto again = calibrate(found().survey.nominal, found().survey.pings, found().survey.trajectory, quickOptions());
  EXPECT_EQ(correctionsOf(again.state), correctionsOf(found().result.state));
  EXPECT_EQ(again.observability.parameters[kTime].sigma, found().result.observability.parameters[kTime].sigma);
}

TEST(Calibrator, CommonHeight_IsNeverClaimed) {
  // A seabed of unknown height rises with both sonars: whatever the survey, this cannot be told.
  for (const int z : {kZ + 0, kZ + kWantedSonarParameters})
    EXPECT_EQ(found().result.observability.parameters[static_cast<std::size_t>(z)].verdict, Verdict::Unobservable);
}

TEST(Calibrator, StraightRunOverLevelBed_ClaimsNoPlaceAndNoHeading) {
  IdealSurveyOptions options;
  options.relief = options.turns = options.waves = false;
  options.duration_s = 60;
  const auto survey = test::idealSurvey(options);
  const auto result = calibrate(survey.nominal, survey.pings, survey.trajectory, quickOptions());
  for (const int i : {int{kX}, int{kY}, int{kTime}, kX + kWantedSonarParameters, kY + kWantedSonarParameters,
                      kRotY + kWantedSonarParameters, kTime + kWantedSonarParameters}) {
    EXPECT_EQ(result.observability.parameters[static_cast<std::size_t>(i)].verdict, Verdict::Unobservable)
        << parameterName(i);
    // What little of it is known together with others may move it, but not beyond what was known before.
    EXPECT_LT(std::abs(correctionsOf(result.state)[i]), priorSigmaOf(i, {})) << parameterName(i);
  }
}

TEST(Calibrator, TooFewEchoes_SaysSo) {
  auto survey = test::idealSurvey({});
  survey.pings.resize(5);
  EXPECT_THROW(calibrate(survey.nominal, survey.pings, survey.trajectory, {}), core::InputError);
  EXPECT_THROW(calibrate(survey.nominal, survey.pings, {}, {}), core::InputError);
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
