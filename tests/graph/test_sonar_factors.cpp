#include <gtest/gtest.h>

#include "synthetic_seabed.h"
#include "synthetic_survey.h"

using namespace s2s;
using namespace s2s::graph;
using namespace s2s::graph::test;

namespace {

/// Two laps over one seabed; a submap every third keyframe.
struct SonarSurvey {
  SyntheticSurvey survey = makeLaps(2, 30, 15, 21);
  SyntheticSeabed seabed{0.06, 22};
};

GraphSlamOptions sonarOptions() {
  GraphSlamOptions options;
  options.consistency.driftTranslation_m = 1e-4;
  options.consistency.driftRotation_rad = 1e-5;
  options.loops.enabled = false;
  options.sonar.odometryMemory_m = 0;
  // The synthetic points have white noise only.
  options.sonar.correlatedFactors = 1;
  auto& registration = options.sonar.registration;
  registration.floorHorizontal_m = registration.floorHeight_m = 0.005;
  registration.floorTilt_rad = registration.floorYaw_rad = 0.001;
  return options;
}

enum class Kind { stereo, swath };

void run(GraphSlam& slam, const SonarSurvey& sonar, bool withSubmaps, Kind kind = Kind::stereo) {
  FixedRandom random(23);
  const SyntheticSurvey& survey = sonar.survey;
  for (std::size_t k = 0; k < survey.odometry.size(); ++k) {
    slam.addKeyframe(keyframeInput(survey, k));
    if (!withSubmaps || k % 3 != 1) continue;
    AcousticSubmap submap;
    submap.time = keyframeInput(survey, k).time;
    submap.T_odom_vehicle = survey.odometry[k];
    (kind == Kind::stereo ? submap.stereo_vehicle : submap.swath_vehicle) =
        sonar.seabed.seen(survey.truth[k], 5, 3000, 0.03, random);
    slam.addSubmap(submap);
  }
  slam.optimizeNow();
}

}  // namespace

TEST(SonarFactors, SecondLapOverTheSameSeabed_LowersTheError) {
  const SonarSurvey sonar;
  GraphSlam without(sonarOptions()), with(sonarOptions());
  run(without, sonar, false);
  run(with, sonar, true);
  EXPECT_LT(rmsError_m(with, sonar.survey), 0.7 * rmsError_m(without, sonar.survey));
  // 30 submaps of the second lap, most of which find their place.
  EXPECT_GE(with.statistics().sonarAccepted, 20);
  // They are no loop closures of the LiDAR.
  EXPECT_EQ(with.statistics().accepted, 0);
  EXPECT_EQ(with.statistics().candidates, 0);
}

TEST(SonarFactors, AcceptedFactors_AreWithinTheirCovarianceOfTheTruth) {
  const SonarSurvey sonar;
  GraphSlam slam(sonarOptions());
  run(slam, sonar, true);
  int outside = 0, accepted = 0;
  for (const auto& factor : slam.loopClosures()) {
    if (factor.status != ClosureStatus::accepted) continue;
    EXPECT_EQ(factor.source, ClosureSource::sonar);
    const auto& truth = sonar.survey.truth;
    const core::Isometry T =
        truth[static_cast<std::size_t>(factor.from)].inverse() * truth[static_cast<std::size_t>(factor.to)];
    const core::Vector6 error = difference(T, factor.T_from_to);
    ++accepted;
    if (error.dot(factor.covariance.inverse() * error) > 16.8) ++outside;  // 6 degrees of freedom, 99 %
  }
  // Of some 30, at most two beyond the 99 % quantile (the odometry within submaps adds a little).
  EXPECT_GT(accepted, 0);
  EXPECT_LE(outside, 2);
}

TEST(SonarFactors, SwitchedOff_TheGraphIsAsBefore) {
  const SonarSurvey sonar;
  GraphSlamOptions off = sonarOptions();
  off.sonar.enabled = false;
  GraphSlam never(sonarOptions()), switchedOff(off);
  run(never, sonar, false);
  run(switchedOff, sonar, true);
  ASSERT_EQ(never.keyframes().size(), switchedOff.keyframes().size());
  for (std::size_t k = 0; k < never.keyframes().size(); ++k)
    EXPECT_EQ(never.keyframes()[k].T_map_vehicle.matrix(), switchedOff.keyframes()[k].T_map_vehicle.matrix());
  EXPECT_TRUE(switchedOff.loopClosures().empty());
  EXPECT_EQ(switchedOff.statistics().submaps, 0);
}

TEST(SonarFactors, StereoPointsThatTheOdometryRemembers_CountOnlyOnce) {
  const SonarSurvey sonar;
  GraphSlamOptions remembering = sonarOptions();
  remembering.sonar.odometryMemory_m = 1000;
  GraphSlam stereo(remembering), swath(remembering);
  run(stereo, sonar, true, Kind::stereo);
  EXPECT_EQ(stereo.statistics().sonarAccepted, 0);
  // Line-scan points never were in the odometry.
  run(swath, sonar, true, Kind::swath);
  EXPECT_GE(swath.statistics().sonarAccepted, 20);
}

TEST(SonarFactors, SubmapWithoutPointsOrKeyframes_IsPassedOver) {
  GraphSlam slam(sonarOptions());
  AcousticSubmap submap;
  slam.addSubmap(submap);  // no keyframe yet
  const SyntheticSurvey survey = makeLaps(1, 20, 10, 24);
  slam.addKeyframe(keyframeInput(survey, 0));
  slam.addSubmap(submap);  // no points
  submap.T_odom_vehicle.translation().x() = std::numeric_limits<double>::quiet_NaN();
  slam.addSubmap(submap);
  EXPECT_EQ(slam.statistics().submaps, 0);
}
