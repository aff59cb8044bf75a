#include <gtest/gtest.h>

#include <iostream>

#include "replay.h"

namespace s2s::odometry {
namespace {

using namespace synthetic;

TEST(Odometry, RoomWithImu_FollowsTheTruth) {
  const Record record;
  const Replay run = replay(record);
  ASSERT_EQ(run.results.size(), 120U);
  const Worst worst = worstError(run, record);
  std::cout << "worst " << worst.translation_m << " m " << worst.rotation_rad << " rad\n";
  const auto& last = run.results.back();
  std::cout << "bias " << last.gyroBias_radps.transpose() << " acc " << last.accelBias_mps2.transpose() << " up "
            << last.up_odom.transpose() << " sigma " << last.gravitySigma_rad << " it " << last.iterations << " match "
            << last.matchCount << "/" << last.pointCount << " scale " << last.residualScale << "\n";
  EXPECT_LT(worst.translation_m, 0.02);
  EXPECT_LT(worst.rotation_rad, 0.002);
}

TEST(Odometry, RoomWithoutImu_FollowsTheTruth) {
  Record record;
  record.hasImu = false;
  const Replay run = replay(record);
  ASSERT_EQ(run.results.size(), 120U);
  const Worst worst = worstError(run, record);
  std::cout << "worst " << worst.translation_m << " m " << worst.rotation_rad << " rad\n";
  EXPECT_LT(worst.translation_m, 0.03);
  EXPECT_LT(worst.rotation_rad, 0.003);
}

}  // namespace
}  // namespace s2s::odometry
