#include <gtest/gtest.h>

#include "s2s/mapper/latency_monitor.h"

namespace s2s::mapper {
namespace {

TEST(LatencyMonitor, OneToHundredMilliseconds_GiveTheirQuantiles) {
  LatencyMonitor monitor(true);
  for (int ms = 100; ms >= 1; --ms) monitor.add("stage", std::chrono::milliseconds(ms));
  const auto all = monitor.statistics();
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].count, 100U);
  // Between the 50th and 51st, the 95th and 96th of a hundred values.
  EXPECT_NEAR(all[0].median_s, 0.0505, 0.0006);
  EXPECT_NEAR(all[0].p95_s, 0.0955, 0.0006);
  EXPECT_DOUBLE_EQ(all[0].max_s, 0.1);
}

TEST(LatencyMonitor, RecordThatArrived_IsMeasuredForEachName) {
  LatencyMonitor monitor(true);
  monitor.arrived(Role::Lidar, 1000);
  monitor.arrived(Role::Lidar, 2000);
  monitor.done("pose", Role::Lidar, 1000);
  monitor.done("pose", Role::Lidar, 2000);
  monitor.done("map", Role::Lidar, 1000);
  monitor.done("pose", Role::Lidar, 1500);            // never arrived
  monitor.done("pose", Role::SonarHorizontal, 1000);  // another sensor's
  const auto all = monitor.statistics();
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].name, "map");
  EXPECT_EQ(all[0].count, 1U);
  EXPECT_EQ(all[1].count, 2U);
  EXPECT_GE(all[1].median_s, 0);
}

TEST(LatencyMonitor, Disabled_KeepsNothing) {
  LatencyMonitor monitor(false);
  monitor.arrived(Role::Lidar, 1000);
  monitor.done("pose", Role::Lidar, 1000);
  monitor.add("stage", std::chrono::milliseconds(1));
  EXPECT_TRUE(monitor.statistics().empty());
}

}  // namespace
}  // namespace s2s::mapper
