#include <gtest/gtest.h>

#include <cmath>

#include "canal_survey.h"
#include "s2s/mapper/survey_mapper.h"

namespace s2s::mapper {
namespace {

constexpr double kDuration_s = 75;  // some 90 m: past the track length before which GNSS is not judged
constexpr double kSpoofFrom_s = 35;

/// A piece of the canal with a coarse LiDAR and no sonars; the fixes of an honest receiver and of one that is led 50 m
/// away.
CanalSurvey simulated() {
  CanalSurvey survey;
  sim::SimulationOptions options;
  options.duration_s = kDuration_s;
  options.sonarHorizontal.enabled = options.sonarVertical.enabled = false;
  options.lidar.columns = 512;
  survey.add(options, [](const mrpt::obs::CObservation&) { return true; });
  options.lidar.enabled = false;
  options.gnss.label = "SPOOFED";
  options.faults.spoofFrom_s = kSpoofFrom_s;
  options.faults.spoofDrift_mps = 50 / (kDuration_s - kSpoofFrom_s);
  survey.add(options, [](const mrpt::obs::CObservation& record) { return record.sensorLabel == "SPOOFED"; });
  return survey;
}

const CanalSurvey& survey() {
  static const CanalSurvey kSurvey = simulated();
  return kSurvey;
}

struct Outcome {
  double error_m = 0;  ///< RMS of the positions, after alignment at the first pose
  graph::GnssReport gnss;
};

Outcome mapWith(const std::string& gnssLabel) {
  SurveyConfig config = canalConfig();
  config.mapper.gnss.label = gnssLabel;
  SurveyMapper mapper(config, 1);
  for (const auto& record : survey().records) mapper.push(record, record->sensorLabel);
  mapper.finish();
  double sum = 0;
  const auto errors_m = survey().positionErrors_m(mapper.trajectory());
  for (const double error_m : errors_m) sum += error_m * error_m;
  return {std::sqrt(sum / static_cast<double>(errors_m.size())), mapper.graph().gnssReport()};
}

/// Made once: both tests compare with it.
const Outcome& without() {
  static const Outcome kOutcome = mapWith("none of these");
  return kOutcome;
}

TEST(GnssInTheMapper, HonestReceiver_IsTrustedAndDoesNotHurt) {
  const Outcome with = mapWith("GNSS");
  EXPECT_EQ(with.gnss.state, graph::GnssState::trusted);
  EXPECT_TRUE(with.gnss.T_enu_map);
  // The promise of the acceptance: less than a centimetre.
  EXPECT_LT(with.error_m, without().error_m + 0.01);
}

TEST(GnssInTheMapper, SpoofWalkingFiftyMetresAway_LeavesTheMapAndIsReported) {
  const Outcome with = mapWith("SPOOFED");
  EXPECT_EQ(with.gnss.state, graph::GnssState::distrusted);
  EXPECT_LT(with.error_m, without().error_m + 0.01);
  ASSERT_FALSE(with.gnss.spans.empty());
  // At 1.25 m/s the lie needs some ten seconds to leave the noise of a receiver of 2.75 m (3.5 sigma).
  const double since_s = core::secondsBetween(survey().truth.front().time, with.gnss.spans.front().from);
  EXPECT_GE(since_s, kSpoofFrom_s);
  EXPECT_LE(since_s, kSpoofFrom_s + 20);
}

TEST(GnssInTheMapper, NoReceiver_IsAbsent) { EXPECT_EQ(without().gnss.state, graph::GnssState::absent); }

}  // namespace
}  // namespace s2s::mapper
