#include <gtest/gtest.h>

#include "s2s/graph/graph_slam.h"
#include "synthetic_survey.h"

using namespace s2s;
using namespace s2s::graph;
using namespace s2s::graph::test;

namespace {

constexpr unsigned kTown = 118;

/// The map of one lap through a town, keyframes at their true poses.
std::unique_ptr<PriorMap> mapOfTown(unsigned town, const SyntheticSurvey& survey, const GraphSlamOptions& options) {
  const SyntheticTown houses(60, 40, town);
  FixedRandom random(201);
  std::vector<PriorKeyframe> keyframes;
  for (const auto& T : survey.truth) keyframes.push_back({T, voxelDownsample(houses.scan(T, 40, random), 0.4)});
  return std::make_unique<PriorMap>(std::move(keyframes), options.places, options.registration, options.loops.submap_m);
}

/// Keyframes `from` to `to` of the survey, in an odometry frame that starts at the first of them.
void surveyAgain(GraphSlam& slam, const SyntheticSurvey& survey, std::size_t from, std::size_t to) {
  const SyntheticTown houses(60, 40, kTown);
  FixedRandom random(202);
  for (std::size_t k = from; k < to; ++k) {
    KeyframeInput input = keyframeInput(survey, k);
    // The odometry is level but knows neither place nor heading.
    const core::Isometry& first = survey.odometry[from];
    const double yaw = std::atan2(first.linear()(1, 0), first.linear()(0, 0));
    const core::Isometry T_world_odom =
        core::isometryFromXyzYpr(first.translation().x(), first.translation().y(), first.translation().z(), yaw, 0, 0);
    input.T_odom_vehicle = T_world_odom.inverse() * survey.odometry[k];
    // Half a metre beside the old path and turned by ten degrees, so that no scan repeats an old one.
    input.T_odom_vehicle = input.T_odom_vehicle * core::isometryFromXyzYpr(0, 0.5, 0, 0.17, 0, 0);
    input.cloud_vehicle = houses.scan(survey.truth[k] * core::isometryFromXyzYpr(0, 0.5, 0, 0.17, 0, 0), 40, random);
    slam.addKeyframe(input);
  }
  slam.optimizeNow();
}

}  // namespace

TEST(PriorMap, SurveyFromTheMiddle_FindsItsPlaceAndStandsInTheOldFrame) {
  const SyntheticSurvey survey = makeLaps(1, 60, 40, 203);
  const GraphSlamOptions options;
  for (const std::size_t from : {40U, 90U}) {
    GraphSlam slam(options, mapOfTown(kTown, survey, options));
    surveyAgain(slam, survey, from, from + 25);
    const RelocationReport report = slam.relocationReport();
    ASSERT_TRUE(report.located) << from;
    EXPECT_GE(report.believed, options.relocation.minSupport);
    for (const auto& keyframe : slam.keyframes()) {
      const core::Isometry truth =
          survey.truth[from + static_cast<std::size_t>(keyframe.id)] * core::isometryFromXyzYpr(0, 0.5, 0, 0.17, 0, 0);
      // Registrations of 1 cm points and an odometry of 5 mm a step; the promise is 0.10 m.
      EXPECT_LT((keyframe.T_map_vehicle.translation() - truth.translation()).norm(), 0.05) << keyframe.id;
      EXPECT_LT(core::angleBetween(keyframe.T_map_vehicle.linear(), truth.linear()), 0.01) << keyframe.id;
    }
  }
}

TEST(PriorMap, MapOfAnotherTown_IsNotTakenForThisOne) {
  const SyntheticSurvey survey = makeLaps(1, 60, 40, 204);
  const GraphSlamOptions options;
  GraphSlam slam(options, mapOfTown(kTown + 1, survey, options));
  surveyAgain(slam, survey, 40, 65);
  const RelocationReport report = slam.relocationReport();
  EXPECT_TRUE(report.wanted);
  EXPECT_FALSE(report.located);
  // The new map keeps the frame of its own odometry.
  EXPECT_LT(slam.keyframes().front().T_map_vehicle.translation().norm(), 1);
}

TEST(PriorMap, FewerKeyframesThanMustAgree_IsNotLocated) {
  const SyntheticSurvey survey = makeLaps(1, 60, 40, 205);
  const GraphSlamOptions options;
  GraphSlam slam(options, mapOfTown(kTown, survey, options));
  // Several candidates of one keyframe that lead to the same pose are one piece of evidence.
  surveyAgain(slam, survey, 40, 40 + static_cast<std::size_t>(options.relocation.minSupport) - 1);
  EXPECT_FALSE(slam.relocationReport().located);
}

TEST(PriorMap, NonePrior_IsNotWanted) { EXPECT_FALSE(GraphSlam().relocationReport().wanted); }
