#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "canal_survey.h"
#include "s2s/mapper/survey_mapper.h"

namespace s2s::mapper {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kDuration_s = 8.0;  // the vessel lies still for two seconds and then sets off

/// A few seconds of the canal, simulated once for all tests.
const CanalSurvey& survey() {
  static const CanalSurvey kSurvey = [] {
    CanalSurvey survey;
    sim::SimulationOptions options;
    options.duration_s = kDuration_s;
    survey.add(options, [](const mrpt::obs::CObservation&) { return true; });
    return survey;
  }();
  return kSurvey;
}

std::unique_ptr<SurveyMapper> mapped(const SurveyConfig& config, int threads) {
  auto mapper = std::make_unique<SurveyMapper>(config, threads);
  for (const auto& record : survey().records) mapper->push(record, record->sensorLabel);
  mapper->finish();
  return mapper;
}

using Point = std::array<double, 4>;  // x, y, z, sigma

/// The points of a layer in the map's order, for comparison bit by bit.
std::vector<Point> pointsOf(const SurveyMapper& mapper, map::Layer layer) {
  std::vector<Point> points;
  mapper.map().forEachPoint(layer, [&points](const map::MapPoint& point) {
    points.push_back({point.p_map.x(), point.p_map.y(), point.p_map.z(), point.sigma_m});
  });
  return points;
}

TEST(SurveyMapper, ShortSurvey_PosesFollowTheTruth) {
  const auto mapper = mapped(canalConfig(), 1);
  const auto poses = mapper->trajectory();
  ASSERT_GT(poses.size(), 0.8 * 10 * kDuration_s);
  // A short path of some metres; 0.15 m is what the demo's whole path is held to.
  for (const double error_m : survey().positionErrors_m(poses)) EXPECT_LT(error_m, 0.15);
}

TEST(SurveyMapper, ShortSurvey_FillsAllLayers) {
  const auto mapper = mapped(canalConfig(), 1);
  for (const auto layer : map::kLayers) EXPECT_GT(mapper->map().pointCount(layer), 100u) << map::layerName(layer);
  EXPECT_GE(mapper->graph().keyframes().size(), 4u);  // one a metre of some four
  // The vehicle's origin is on the waterline; waves move it by some centimetres.
  EXPECT_NEAR(mapper->waterHeight_m(), 0, 0.2);
}

TEST(SurveyMapper, OneThread_SameMapBitForBit) {
  const auto once = mapped(canalConfig(), 1), again = mapped(canalConfig(), 1);
  for (const auto layer : map::kLayers) EXPECT_TRUE(pointsOf(*once, layer) == pointsOf(*again, layer));
}

TEST(SurveyMapper, SeveralThreads_SamePosesAndSamePoints) {
  const auto one = mapped(canalConfig(), 1), several = mapped(canalConfig(), 4);
  // Odometry and graph see their input in the same order; only the interleaving of map insertions may differ.
  const auto a = one->odometryTrajectory(), b = several->odometryTrajectory();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(a.poses()[i].T.isApprox(b.poses()[i].T, 1e-12));
  for (const auto layer : map::kLayers) {
    auto some = pointsOf(*one, layer), others = pointsOf(*several, layer);
    std::sort(some.begin(), some.end());
    std::sort(others.begin(), others.end());
    EXPECT_TRUE(some == others) << map::layerName(layer) << ": " << some.size() << " and " << others.size();
  }
}

TEST(SurveyMapper, SonarsSilent_MapsWithLidarAlone) {
  SurveyMapper mapper(canalConfig(), 1);
  for (const auto& record : survey().records)
    if (record->sensorLabel == "LIDAR" || record->sensorLabel == "IMU") mapper.push(record, "");
  mapper.finish();
  EXPECT_GT(mapper.map().pointCount(map::Layer::Lidar), 1000u);
  EXPECT_EQ(mapper.map().pointCount(map::Layer::Stereo), 0u);
}

TEST(SurveyMapper, ImuLabelledOtherwise_IsWarnedOf) {
  const auto faultsWith = [](odometry::ImuUse use) {
    SurveyConfig config = canalConfig();
    config.odometry.imuUse = use;
    SurveyMapper mapper(config, 1);
    for (const auto& record : survey().records)
      if (record->sensorLabel == "LIDAR") mapper.push(record, "");
    mapper.finish();
    return mapper.faults().lines();
  };
  EXPECT_THAT(faultsWith(odometry::ImuUse::automatic), Contains(HasSubstr("no record of an IMU labelled 'IMU'")));
  EXPECT_THAT(faultsWith(odometry::ImuUse::never), Not(Contains(HasSubstr("IMU"))));
}

TEST(SurveyMapper, RealTimeWithoutTime_DropsCountsAndStillMaps) {
  auto impatient = canalConfig();
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
  EXPECT_TRUE(mapped(canalConfig(), 2)->latencies().statistics().empty());
}

TEST(SurveyMapper, GivenUpHalfway_EndsAtOnceAndPrintsNothing) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  {
    SurveyMapper mapper(canalConfig(), 4);
    for (const auto& record : survey().records)
      if (record->sensorLabel == "IMU") mapper.push(record, "");
  }
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(SurveyMapper, NothingPushed_FinishesEmpty) {
  SurveyMapper mapper(canalConfig(), 2);
  mapper.finish();
  EXPECT_TRUE(mapper.map().isEmpty());
  EXPECT_TRUE(mapper.trajectory().empty());
}

}  // namespace
}  // namespace s2s::mapper
