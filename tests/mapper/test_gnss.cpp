#include <gtest/gtest.h>

#include <cmath>

#include "s2s/mapper/survey_mapper.h"
#include "s2s/sim/scene_loader.h"
#include "s2s/sim/survey_simulator.h"

namespace s2s::mapper {
namespace {

constexpr double kDuration_s = 75;  // some 90 m: past the track length before which GNSS is not judged
constexpr double kSpoofFrom_s = 35;

/// A piece of the canal with a coarse LiDAR and no sonars; the fixes of an honest receiver and of one that is led 50 m
/// away.
struct Survey {
  std::vector<mrpt::obs::CObservation::Ptr> records;
  core::Trajectory truth;  // T_world_vehicle

  Survey() {
    auto ini = core::IniFile::load(std::string(S2S_SOURCE_DIR) + "/share/scenes/canal.ini");
    const auto scene = sim::loadScene(ini);
    sim::SimulationOptions options;
    options.duration_s = kDuration_s;
    options.sonarHorizontal.enabled = options.sonarVertical.enabled = false;
    options.lidar.columns = 512;
    const sim::SurveySimulator honest(scene, 1, options);
    collect(honest, false);
    for (double t_s = 0; t_s <= kDuration_s; t_s += 0.01)
      truth.append(options.startTime + core::durationNs(t_s), honest.motion().pose(t_s));
    options.lidar.enabled = false;
    options.gnss.label = "SPOOFED";
    options.faults.spoofFrom_s = kSpoofFrom_s;
    options.faults.spoofDrift_mps = 50 / (kDuration_s - kSpoofFrom_s);
    collect(sim::SurveySimulator(scene, 1, options), true);
    std::stable_sort(records.begin(), records.end(), [](const auto& a, const auto& b) {
      return core::fromMrptTime(a->timestamp) < core::fromMrptTime(b->timestamp);
    });
  }

  void collect(const sim::SurveySimulator& simulator, bool onlyGnss) {
    sim::SimulationSinks sinks;
    sinks.record = [this, onlyGnss](const mrpt::obs::CObservation::Ptr& record) {
      if (!onlyGnss || record->sensorLabel == "SPOOFED") records.push_back(record);
    };
    simulator.run(sinks);
  }
};

const Survey& survey() {
  static const Survey kSurvey;
  return kSurvey;
}

struct Outcome {
  double error_m = 0;  ///< RMS of the positions, after alignment at the first pose
  graph::GnssReport gnss;
};

Outcome mapWith(const std::string& gnssLabel) {
  SurveyConfig config;
  config.odometry.scan.hullBox = {-1.25, -0.65, -0.75, 1.1, 0.65, 1.25};
  config.mapper.gnss.label = gnssLabel;
  SurveyMapper mapper(config, 1);
  for (const auto& record : survey().records) mapper.push(record, record->sensorLabel);
  mapper.finish();
  const auto poses = mapper.trajectory();
  const core::Isometry T_world_map = *survey().truth.at(poses.front().time) * poses.front().T.inverse();
  double sum = 0;
  std::size_t count = 0;
  for (const auto& pose : poses.poses()) {
    const auto truth = survey().truth.at(pose.time);
    if (!truth) continue;
    sum += (truth->translation() - (T_world_map * pose.T).translation()).squaredNorm();
    ++count;
  }
  return {std::sqrt(sum / static_cast<double>(count)), mapper.graph().gnssReport()};
}

/// The three runs, made once.
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
