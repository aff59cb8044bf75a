#include <gtest/gtest.h>

#include "s2s/mapper/survey_mapper.h"
#include "s2s/sim/scene_loader.h"
#include "s2s/sim/survey_simulator.h"

namespace s2s::mapper {
namespace {

constexpr double kDuration_s = 8.0;  // the vessel lies still for two seconds and then sets off

/// A few seconds of the canal, simulated once for all tests.
struct Survey {
  std::vector<mrpt::obs::CObservation::Ptr> records;
  core::Trajectory truth;  // T_world_vehicle

  Survey() {
    auto ini = core::IniFile::load(std::string(S2S_SOURCE_DIR) + "/share/scenes/canal.ini");
    const auto scene = sim::loadScene(ini);
    sim::SimulationOptions options;
    options.duration_s = kDuration_s;
    const sim::SurveySimulator simulator(scene, 1, options);
    sim::SimulationSinks sinks;
    sinks.record = [this](const mrpt::obs::CObservation::Ptr& record) { records.push_back(record); };
    simulator.run(sinks);
    for (double t_s = 0; t_s <= kDuration_s; t_s += 0.01)
      truth.append(options.startTime + core::durationNs(t_s), simulator.motion().pose(t_s));
  }
};

const Survey& survey() {
  static const Survey kSurvey;
  return kSurvey;
}

SurveyConfig config() {
  SurveyConfig config;
  // The simulated vessel's own parts, as its survey.ini has them.
  config.odometry.scan.hullBox = {-1.25, -0.65, -0.75, 1.1, 0.65, 1.25};
  return config;
}

std::unique_ptr<SurveyMapper> mapped(const SurveyConfig& config, int threads) {
  auto mapper = std::make_unique<SurveyMapper>(config, threads);
  for (const auto& record : survey().records) mapper->push(record, record->sensorLabel);
  mapper->finish();
  return mapper;
}

/// Every coordinate of the map, for comparison bit by bit.
std::vector<double> coordinates(const SurveyMapper& mapper) {
  std::vector<double> values;
  for (const auto layer : map::kLayers)
    mapper.map().forEachPoint(layer, [&values](const map::MapPoint& point) {
      values.insert(values.end(), {point.p_map.x(), point.p_map.y(), point.p_map.z(), point.sigma_m});
    });
  return values;
}

TEST(SurveyMapper, ShortSurvey_PosesFollowTheTruth) {
  const auto mapper = mapped(config(), 1);
  const auto poses = mapper->trajectory();
  ASSERT_GT(poses.size(), 0.8 * 10 * kDuration_s);
  const core::Isometry T_world_map = *survey().truth.at(poses.front().time) * poses.front().T.inverse();
  for (const auto& pose : poses.poses()) {
    const auto truth = survey().truth.at(pose.time);
    if (!truth) continue;
    // A short path of some metres; 0.15 m is what the demo's whole path is held to.
    EXPECT_LT((truth->translation() - (T_world_map * pose.T).translation()).norm(), 0.15);
  }
}

TEST(SurveyMapper, ShortSurvey_FillsAllLayers) {
  const auto mapper = mapped(config(), 1);
  for (const auto layer : map::kLayers) EXPECT_GT(mapper->map().pointCount(layer), 100u) << map::layerName(layer);
  EXPECT_GE(mapper->graph().keyframes().size(), 4u);  // one a metre of some four
  // The vehicle's origin is on the waterline; waves move it by some centimetres.
  EXPECT_NEAR(mapper->waterHeight_m(), 0, 0.2);
}

TEST(SurveyMapper, OneThread_SameMapBitForBit) {
  EXPECT_EQ(coordinates(*mapped(config(), 1)), coordinates(*mapped(config(), 1)));
}

TEST(SurveyMapper, SeveralThreads_SamePosesAndPointCounts) {
  const auto one = mapped(config(), 1), several = mapped(config(), 4);
  // Odometry and graph see their input in the same order; only the interleaving of map insertions may differ.
  const auto a = one->odometryTrajectory(), b = several->odometryTrajectory();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(a.poses()[i].T.isApprox(b.poses()[i].T, 1e-12));
  for (const auto layer : map::kLayers)
    EXPECT_EQ(one->map().pointCount(layer), several->map().pointCount(layer)) << map::layerName(layer);
}

TEST(SurveyMapper, SonarsSilent_MapsWithLidarAlone) {
  SurveyMapper mapper(config(), 1);
  for (const auto& record : survey().records)
    if (record->sensorLabel == "LIDAR" || record->sensorLabel == "IMU") mapper.push(record, "");
  mapper.finish();
  EXPECT_GT(mapper.map().pointCount(map::Layer::Lidar), 1000u);
  EXPECT_EQ(mapper.map().pointCount(map::Layer::Stereo), 0u);
}

TEST(SurveyMapper, RealTimeWithoutTime_DropsCountsAndStillMaps) {
  auto impatient = config();
  impatient.mapper.queueCapacity = 2;
  SurveyMapper mapper(impatient, 2, true);
  // Pushed as fast as memory gives them, far faster than any machine maps.
  for (const auto& record : survey().records) mapper.push(record, record->sensorLabel);
  mapper.finish();
  const auto faults = mapper.faults().lines();
  EXPECT_TRUE(std::any_of(faults.begin(), faults.end(),
                          [](const std::string& line) { return line.find("behind real time") != std::string::npos; }));
  EXPECT_GT(mapper.sweepCount(), 0U);
  const auto latencies = mapper.latencies().statistics();
  const auto pose =
      std::find_if(latencies.begin(), latencies.end(), [](const auto& l) { return l.name == "record: sweep to pose"; });
  ASSERT_NE(pose, latencies.end());
  EXPECT_EQ(pose->count, mapper.sweepCount());  // one for each sweep that was not dropped
  EXPECT_GT(pose->median_s, 0);
}

TEST(SurveyMapper, NotInRealTime_MeasuresNoLatency) {
  EXPECT_TRUE(mapped(config(), 2)->latencies().statistics().empty());
}

TEST(SurveyMapper, NothingPushed_FinishesEmpty) {
  SurveyMapper mapper(config(), 2);
  mapper.finish();
  EXPECT_TRUE(mapper.map().isEmpty());
  EXPECT_TRUE(mapper.trajectory().empty());
}

}  // namespace
}  // namespace s2s::mapper
