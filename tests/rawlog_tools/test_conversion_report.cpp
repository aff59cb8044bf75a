#include "common/conversion_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

using s2s::tools::ConversionReport;
using testing::HasSubstr;

TEST(ConversionReport, RepeatedReasons_AreCountedAndKeepTheirFirstPlace) {
  ConversionReport report;
  report.addRead("pings");
  report.addRead("pings", 2);
  report.addSkipped("bad pings", "byte 7");
  report.addSkipped("bad pings", "byte 9", 4);
  report.addNote("once");
  report.addNote("once");
  EXPECT_EQ(report.readCount("pings"), 3u);
  EXPECT_EQ(report.skippedCount("bad pings"), 5u);
  EXPECT_EQ(report.readCount("never"), 0u);
  EXPECT_THAT(report.text(), HasSubstr("skipped  5 bad pings (first: byte 7)"));
  EXPECT_EQ(report.notes().size(), 1u);
}

TEST(ConversionReport, NothingSkipped_SaysSo) {
  ConversionReport report;
  report.addRead("pings");
  EXPECT_THAT(report.text(), HasSubstr("skipped  nothing"));
}
