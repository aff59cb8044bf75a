#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "s2s/mapper/stereo_pairer.h"

namespace s2s::mapper {
namespace {

constexpr core::TimeNs kMs = core::kNsPerSecond / 1000;

/// A ping without any echo, which pairs like any other.
PendingPing ping(Role role, core::TimeNs time, bool usable = true) {
  std::promise<std::shared_ptr<const sonar::ProcessedPing>> image;
  PendingPing out{role, time, core::Isometry::Identity(), image.get_future().share()};
  auto empty = std::make_shared<sonar::ProcessedPing>();
  empty->image = cv::Mat::zeros(8, 8, CV_8U);
  image.set_value(usable ? std::move(empty) : nullptr);
  return out;
}

/// Runs pings of two sonars through a pairer in order of time; returns the partner of each vertical ping.
std::map<core::TimeNs, core::TimeNs> pairs(const std::vector<core::TimeNs>& horizontal,
                                           const std::vector<core::TimeNs>& vertical) {
  std::map<core::TimeNs, core::TimeNs> made;
  StereoPairer pairer({}, 0.04, [&](core::TimeNs from, core::TimeNs to) {
    made[to] = from;
    return core::Isometry::Identity();
  });
  std::multimap<core::TimeNs, Role> order;
  for (const auto time : horizontal) order.emplace(time, Role::SonarHorizontal);
  for (const auto time : vertical) order.emplace(time, Role::SonarVertical);
  for (const auto& [time, role] : order) pairer.add(ping(role, time));
  pairer.finish();
  return made;
}

TEST(StereoPairer, FifteenAgainstTenHertz_EachVerticalPingGetsTheNearestHorizontal) {
  std::vector<core::TimeNs> horizontal, vertical;
  // Jitter of up to 11 ms, by a fixed pattern.
  for (int i = 0; i < 150; ++i) horizontal.push_back(i * 1000 / 15 * kMs + (i * 37 % 12) * kMs);
  for (int i = 0; i < 100; ++i) vertical.push_back(i * 100 * kMs + (i * 53 % 12) * kMs);
  const auto made = pairs(horizontal, vertical);
  for (const auto time : vertical) {
    core::TimeNs smallest = std::numeric_limits<core::TimeNs>::max();
    for (const auto other : horizontal) smallest = std::min(smallest, std::abs(other - time));
    if (smallest > 40 * kMs) {
      EXPECT_EQ(made.count(time), 0U);
    } else {
      ASSERT_EQ(made.count(time), 1U);
      EXPECT_EQ(std::abs(made.at(time) - time), smallest);
    }
  }
}

TEST(StereoPairer, PartnerTooFarAway_MakesNoPair) {
  EXPECT_TRUE(pairs({0, 200 * kMs}, {100 * kMs}).empty());
  EXPECT_EQ(pairs({0, 139 * kMs}, {100 * kMs}).size(), 1U);
}

TEST(StereoPairer, OneSonarAlone_MakesNoPair) {
  EXPECT_TRUE(pairs({0, 100 * kMs}, {}).empty());
  EXPECT_TRUE(pairs({}, {0, 100 * kMs}).empty());
}

TEST(StereoPairer, UnusablePing_IsPassedOver) {
  int moved = 0;  // the vessel's motion is asked for once a pair
  StereoPairer pairer({}, 0.04, [&moved](core::TimeNs, core::TimeNs) {
    ++moved;
    return core::Isometry::Identity();
  });
  pairer.add(ping(Role::SonarHorizontal, 0, false));
  pairer.add(ping(Role::SonarVertical, 10 * kMs));
  EXPECT_TRUE(pairer.finish().empty());
  EXPECT_EQ(moved, 0);
}

TEST(StereoPairer, ImageNeverMade_IsPassedOver) {
  StereoPairer pairer({}, 0.04, [](core::TimeNs, core::TimeNs) { return core::Isometry::Identity(); });
  pairer.add(ping(Role::SonarHorizontal, 0));
  PendingPing orphan{Role::SonarVertical, 10 * kMs, core::Isometry::Identity(), {}};
  orphan.image = std::promise<std::shared_ptr<const sonar::ProcessedPing>>().get_future().share();
  pairer.add(orphan);
  EXPECT_NO_THROW(pairer.finish());  // else its "broken promise" would hide what failed
}

}  // namespace
}  // namespace s2s::mapper
