#include "s2s/core/time.h"

#include <gtest/gtest.h>
#include <mrpt/core/Clock.h>
#include <mrpt/system/datetime.h>

#include <limits>

#include "s2s/core/error.h"

using namespace s2s;
using core::TimeNs;

TEST(Time, MrptEpoch_Is1601) {
  // 2000-01-01 is 946684800 s after 1970, by the calendar: 30 years of 365 days and 7 leap days.
  EXPECT_EQ(core::fromMrptTime(mrpt::Clock::fromDouble(946684800.0)), 946'684'800'000'000'000);
  EXPECT_EQ((30 * 365 + 7) * 86400, 946684800);
}

TEST(Time, RoundTripThroughMrpt_IsExactToATick) {
  for (const TimeNs t : {TimeNs{0}, TimeNs{1'733'400'000'123'456'700}, TimeNs{100}, TimeNs{-100}, TimeNs{-12'345'600}})
    EXPECT_EQ(core::fromMrptTime(core::toMrptTime(t)), t);
}

TEST(Time, PartsOfATick_AreRoundedDown) {
  EXPECT_EQ(core::fromMrptTime(core::toMrptTime(1'000'000'000'000'000'199)), 1'000'000'000'000'000'100);
  EXPECT_EQ(core::fromMrptTime(core::toMrptTime(-1)), -100);
}

TEST(Time, InvalidMrptTime_BecomesTheEarliestWithoutOverflow) {
  EXPECT_LT(core::fromMrptTime(mrpt::Clock::time_point()), -9'000'000'000'000'000'000);
}

TEST(Time, FormatUnixTime_HasNineDecimalsAlsoBefore1970) {
  EXPECT_EQ(core::formatUnixTime(1'733'400'000'123'456'789), "1733400000.123456789");
  EXPECT_EQ(core::formatUnixTime(5), "0.000000005");
  EXPECT_EQ(core::formatUnixTime(-500'000'000), "-1.500000000");
}

TEST(Time, FormatUtc_IsIso8601) { EXPECT_EQ(core::formatUtc(946'684'800'250'999'999), "2000-01-01T00:00:00.250Z"); }

TEST(Time, Parse_TakesUnixSecondsAndUtc) {
  EXPECT_EQ(core::parseTime("1733400000.25", "t"), 1'733'400'000'250'000'000);
  EXPECT_EQ(core::parseTime("1733400000", "t"), 1'733'400'000'000'000'000);
  EXPECT_EQ(core::parseTime("1.000000001", "t"), 1'000'000'001);
  EXPECT_EQ(core::parseTime("2000-01-01T00:00:00Z", "t"), 946'684'800'000'000'000);
  EXPECT_EQ(core::parseTime("2024-02-29T12:00:00.123456789Z", "t"), 1'709'208'000'123'456'789);
}

TEST(Time, FormattedTimes_ParseBack) {
  const TimeNs t = 1'733'400'000'123'000'000;
  EXPECT_EQ(core::parseTime(core::formatUtc(t), "t"), t);
  EXPECT_EQ(core::parseTime(core::formatUnixTime(t), "t"), t);
}

TEST(Time, TextsThatAreNoTime_AreRefused) {
  for (const char* text : {"", "soon", "-5", "1.", "1.x", "1.1234567890", "99999999999", "9999999999", "2024-12-05",
                           "2024-12-05T12:00:00", "2024-13-05T12:00:00Z", "2023-02-29T12:00:00Z",
                           "2024-12-05T25:00:00Z", "2024-12-05T12:00:00Z ", "2024-1-5T1:0:0Z"})
    EXPECT_THROW(core::parseTime(text, "--start-time"), core::ConfigError) << text;
}

TEST(Time, FormatDuration_ChoosesUnits) {
  EXPECT_EQ(core::formatDuration(0.85), "850 ms");
  EXPECT_EQ(core::formatDuration(12.34), "12.3 s");
  EXPECT_EQ(core::formatDuration(245), "4 min 05 s");
  EXPECT_EQ(core::formatDuration(7380), "2 h 03 min");
}

TEST(Time, DurationNs_RoundsToTheNearest) {
  EXPECT_EQ(core::durationNs(0.1), 100'000'000);
  EXPECT_EQ(core::durationNs(-1.5e-9), -2);  // halves away from zero
}
