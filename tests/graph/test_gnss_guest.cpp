#include <gtest/gtest.h>

#include "s2s/graph/gnss_guest.h"
#include "synthetic_survey.h"

using namespace s2s;
using namespace s2s::graph;
using graph::test::FixedRandom;

namespace {

const core::Isometry kTruth_enu_map = core::isometryFromXyzYpr(500, -300, 12, 0.7, 0, 0);

struct Track {
  std::vector<Keyframe> keyframes;
  std::vector<TiedFix> fixes;
};

/// A gently curved path of 300 m with a fix each 3 m, 1 m of noise.
Track makeTrack(unsigned seed) {
  FixedRandom random(seed);
  Track track;
  for (int k = 0; k < 100; ++k) {
    Keyframe keyframe;
    keyframe.id = k;
    keyframe.time = core::durationNs(k);
    keyframe.T_map_vehicle = core::isometryFromXyzYpr(3.0 * k, 20 * std::sin(0.03 * k), 0, 0.2, 0, 0);
    track.keyframes.push_back(keyframe);
    TiedFix tied;
    tied.keyframe = k;
    tied.p_keyframe_antenna = Eigen::Vector3d(-1, 0, 2);
    tied.fix.time = keyframe.time;
    tied.fix.sigma_m = Eigen::Vector3d::Constant(1);
    tied.fix.p_enu = kTruth_enu_map * (keyframe.T_map_vehicle * tied.p_keyframe_antenna) + random.normal3(1);
    track.fixes.push_back(tied);
  }
  return track;
}

GnssOptions enabled() {
  GnssOptions options;
  options.enabled = true;
  return options;
}

}  // namespace

TEST(GnssGuest, HonestFixes_AreTrustedAndAligned) {
  const Track track = makeTrack(101);
  const GnssAssessment assessment = assessGnss(track.fixes, track.keyframes, enabled());
  EXPECT_EQ(assessment.report.state, GnssState::trusted);
  EXPECT_LE(assessment.report.unbelievable, 2);  // 3.5 sigma in three dimensions: 0.7 %
  ASSERT_TRUE(assessment.report.T_enu_map);
  // 100 fixes of 1 m over 300 m: 0.1 m in the middle, 1 / (sqrt(100) * 87) rad in heading; four of these.
  const Eigen::Vector3d middle(150, 0, 0);
  EXPECT_LT((*assessment.report.T_enu_map * middle - kTruth_enu_map * middle).norm(), 0.6);
  EXPECT_LT(core::angleBetween(assessment.report.T_enu_map->linear(), kTruth_enu_map.linear()), 0.005);
}

TEST(GnssGuest, SpoofWalkingFiftyMetresAway_IsDistrustedAndDated) {
  Track track = makeTrack(102);
  for (int k = 60; k < 100; ++k) track.fixes[k].fix.p_enu.x() += 50.0 * (k - 60) / 40;
  const GnssAssessment assessment = assessGnss(track.fixes, track.keyframes, enabled());
  EXPECT_EQ(assessment.report.state, GnssState::distrusted);
  EXPECT_GT(assessment.report.largestDeviation_m, 40);
  // It begins at fix 60 and is beyond 3.5 sigma (1 to 1.3 m) after about 4 m.
  EXPECT_GE(assessment.report.distrustedSince, core::durationNs(60));
  EXPECT_LE(assessment.report.distrustedSince, core::durationNs(68));
  // One span, from there to the last fix.
  ASSERT_EQ(assessment.report.spans.size(), 1U);
  EXPECT_GE(assessment.report.spans[0].from, core::durationNs(60));  // single believable ones are bridged
  EXPECT_LE(assessment.report.spans[0].from, assessment.report.distrustedSince);
  EXPECT_EQ(assessment.report.spans[0].to, core::durationNs(99));
  EXPECT_GT(assessment.report.spans[0].largestDeviation_m, 40);
  ASSERT_TRUE(assessment.report.T_enu_map);
  const Eigen::Vector3d early(80, 0, 0);
  EXPECT_LT((*assessment.report.T_enu_map * early - kTruth_enu_map * early).norm(), 1.5);
}

TEST(GnssGuest, SingleMultipathFixes_AreLeftOutAndTheRestTrusted) {
  Track track = makeTrack(103);
  for (const int k : {10, 33, 34, 71}) track.fixes[k].fix.p_enu += Eigen::Vector3d(15, -10, 5);
  const GnssAssessment assessment = assessGnss(track.fixes, track.keyframes, enabled());
  EXPECT_EQ(assessment.report.state, GnssState::trusted);
  for (const int k : {10, 33, 34, 71}) EXPECT_FALSE(assessment.believable[k]) << k;
  EXPECT_LE(assessment.report.unbelievable, 6);
  EXPECT_TRUE(assessment.report.spans.empty());  // single fixes are no time of distrust
}

TEST(GnssGuest, MirroredTrack_IsDistrustedAsAWhole) {
  Track track = makeTrack(104);
  for (auto& tied : track.fixes) tied.fix.p_enu.y() = -3 * tied.fix.p_enu.y();
  EXPECT_EQ(assessGnss(track.fixes, track.keyframes, enabled()).report.state, GnssState::distrusted);
}

TEST(GnssGuest, TooLittleOrNothing_IsNotUsed) {
  Track track = makeTrack(105);
  EXPECT_EQ(assessGnss({}, track.keyframes, enabled()).report.state, GnssState::absent);
  EXPECT_EQ(assessGnss(track.fixes, track.keyframes, {}).report.state, GnssState::absent);
  track.fixes.resize(8);
  EXPECT_EQ(assessGnss(track.fixes, track.keyframes, enabled()).report.state, GnssState::tooShort);
}
