#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "s2s/mapper/fault_log.h"

namespace s2s::mapper {
namespace {

using ::testing::ElementsAre;

TEST(FaultLog, RepeatedFault_IsOneLineWithCountAndFirstPlace) {
  FaultLog log;
  EXPECT_TRUE(log.add("bad ping", "record 7"));
  EXPECT_FALSE(log.add("bad ping", "record 9"));
  EXPECT_TRUE(log.add("gap"));
  EXPECT_THAT(log.lines(), ElementsAre("bad ping (2 times, first: record 7)", "gap"));
}

TEST(FaultLog, CountOfZero_IsNoFault) {
  FaultLog log;
  EXPECT_FALSE(log.add("nothing happened", {}, 0));
  EXPECT_TRUE(log.lines().empty());
}

TEST(FaultLog, CountsGivenAtOnce_Add) {
  FaultLog log;
  log.add("gap", {}, 3);
  log.add("gap", {}, 4);
  EXPECT_THAT(log.lines(), ElementsAre("gap (7 times)"));
}

TEST(FaultLog, MoreKindsThanAnybodyReads_CountAsOne) {
  FaultLog log;
  for (int i = 0; i < 10000; ++i) log.add("range resolution of " + std::to_string(i) + " m", "a place");
  const auto lines = log.lines();
  EXPECT_LE(lines.size(), 101U);
  EXPECT_EQ(lines.front(), "range resolution of 0 m (a place)");
  EXPECT_THAT(lines.back(), ::testing::HasSubstr("(9900 times"));
}

}  // namespace
}  // namespace s2s::mapper
