#include <gtest/gtest.h>

#include "s2s/mapper/odometry_stage.h"

namespace s2s::mapper {
namespace {

constexpr core::TimeNs kStart = 1'733'400'000'000'000'000;

TEST(OdometryStage, NoLidar_PingsAreGivenUpInsteadOfKept) {
  FaultLog faults;
  std::vector<core::TimeNs> abandoned;
  const OdometryStage::Options options;
  OdometryStage stage(options, faults,
                      [&](const OdometryUpdate& update) { abandoned.push_back(update.abandonedUntil); });
  core::TimeNs newest = 0;
  for (int i = 0; i < 3000; ++i) {
    newest = kStart + core::durationNs(0.1 * i);
    std::promise<std::shared_ptr<const sonar::ProcessedPing>> image;
    image.set_value(nullptr);
    stage.addPing({i % 2 == 0 ? Role::SonarHorizontal : Role::SonarVertical, newest, core::Isometry::Identity(),
                   image.get_future().share()});
  }
  ASSERT_FALSE(abandoned.empty());
  EXPECT_TRUE(std::is_sorted(abandoned.begin(), abandoned.end()));
  // Of five minutes none that is older than a minute, the start of the odometry and one portion.
  const double left_s = core::secondsBetween(abandoned.back(), newest);
  EXPECT_LT(left_s, 60 + odometry::OdometryOptions().initialisation_s + 1.1);
  EXPECT_GT(left_s, 60);
}

}  // namespace
}  // namespace s2s::mapper
