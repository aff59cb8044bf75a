#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "s2s/mapper/sonar_stage.h"

namespace s2s::mapper {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr core::TimeNs kStart = 1'733'400'000'000'000'000;

core::TimeNs at(double t_s) { return kStart + core::durationNs(t_s); }

/// A stage, and the times (milliseconds) of the line-scans that it placed.
struct SonarStageTest : ::testing::Test {
  FaultLog faults;
  std::vector<core::TimeNs> placed_ms;
  SonarStage stage{
      {}, faults, [this](const SonarScan& scan) { placed_ms.push_back((scan.time - kStart) / 1'000'000); }};

  void addPing(double t_s) {
    auto ping = std::make_shared<obs::CObservationImagingSonar>();
    ping->timestamp = core::toMrptTime(at(t_s));
    ping->beamCount = 16;
    ping->rangeCount = 100;
    ping->samples.assign(1600, 10);
    for (int beam = 0; beam < 16; ++beam) ping->bearings_rad.push_back(0.05F * static_cast<float>(beam - 8));
    ping->rangeResolution_m = 0.1;
    ping->verticalAperture_rad = 0.3;
    std::promise<std::shared_ptr<const sonar::ProcessedPing>> image;
    stage.addPing({Role::SonarHorizontal, ping}, image);
  }

  void addPoses(double from_s, double to_s) {
    OdometryUpdate update;
    for (double t_s = from_s; t_s <= to_s; t_s += 0.1) update.path.push_back({at(t_s), core::Isometry::Identity()});
    stage.addPoses(update);
  }
};

TEST_F(SonarStageTest, PingBetweenPoses_IsPlacedAtItsTime) {
  addPing(0.25);
  addPing(0.95);  // still ahead of the poses
  addPoses(0, 0.6);
  EXPECT_THAT(placed_ms, ElementsAre(250));
  addPoses(0.7, 1.2);
  EXPECT_THAT(placed_ms, ElementsAre(250, 950));
}

TEST_F(SonarStageTest, PingsComeSecondsAfterTheSweepsOfTheirTime_AreStillPlaced) {
  for (double t_s = 0; t_s < 10; t_s += 0.5) addPoses(t_s, t_s + 0.4);
  addPing(2.25);
  addPoses(10, 10.4);
  EXPECT_THAT(placed_ms, ElementsAre(2250));
}

TEST_F(SonarStageTest, PingBeforeTheFirstPose_IsCountedWithItsTime) {
  addPing(1);
  addPoses(2, 3);
  EXPECT_TRUE(placed_ms.empty());
  EXPECT_THAT(faults.lines(), Contains(HasSubstr("before the first pose")));
}

TEST_F(SonarStageTest, PingsGivenUp_AreNotPlacedLater) {
  addPing(1);
  addPing(2);
  OdometryUpdate update;
  update.abandonedUntil = at(1.5);
  stage.addPoses(update);
  addPoses(0, 3);
  EXPECT_THAT(placed_ms, ElementsAre(2000));
  EXPECT_THAT(faults.lines(), Contains(HasSubstr("no LiDAR sweep")));
}

}  // namespace
}  // namespace s2s::mapper
