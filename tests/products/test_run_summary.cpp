#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "error_text.h"
#include "s2s/core/atomic_file.h"
#include "s2s/core/error.h"
#include "s2s/products/run_summary.h"
#include "temp_folder.h"

namespace s2s::products {
namespace {

using test::errorText;
using test::TempFolder;
using test::writeBytes;
using testing::HasSubstr;

RunSummary sampleSummary() {
  RunSummary s;
  s.inputs = {"survey.rawlog",
              "h\xc3\xa4"
              "fen.rawlog"};
  s.startTime = 1'733'400'000'000'000'001;
  s.endTime = 1'733'400'090'000'000'000;
  s.duration_s = 90;
  s.wall_s = 30;
  s.peakRss_mb = 812.5;
  s.sweeps = 900;
  s.pingsHorizontal = 1350;
  s.pingsVertical = 900;
  s.keyframes = 101;
  s.loopClosures = 7;
  s.points = {10'000'000, 2, 3, 4};
  s.waterHeight_m = -0.125;
  s.warnings = {"a \"quoted\" warning"};
  s.stageTimes_s = {{"odometry", 12.5}};
  s.figures = {{"seabed_area_m2", 1234.5}, {"undefined_m", std::nan("")}};
  return s;
}

TEST(RunSummary, Json_HasTheStatedKeys) {
  const auto json = nlohmann::json::parse(toJson(sampleSummary()));
  for (const char* key : {"duration_s", "wall_s", "realtime_factor", "sweeps", "pings_horizontal", "pings_vertical",
                          "keyframes", "loop_closures", "points", "peak_rss_mb", "warnings", "water_height_m"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(json["realtime_factor"], 3.0);
  EXPECT_EQ(json["points"]["lidar"], 10'000'000);
  EXPECT_EQ(json["points"]["line_vertical"], 4);
  EXPECT_EQ(json["water_height_m"], -0.125);
  EXPECT_EQ(json["warnings"][0], "a \"quoted\" warning");
  EXPECT_TRUE(json["figures"]["undefined_m"].is_null());
}

TEST(RunSummary, DistrustedGnss_ReadsBackWithItsSpans) {
  const TempFolder folder;
  RunSummary s = sampleSummary();
  GnssSummary& gnss = s.gnss.emplace();
  gnss.state = "distrusted";
  gnss.distrusted = true;
  gnss.fixes = 80;
  gnss.unbelievable = 31;
  gnss.largestDeviation_m = 48.25;
  gnss.spans = {{1'733'400'030'000'000'001, 1'733'400'060'000'000'000, 31, 48.25}};
  gnss.mapOrigin = GnssPlace{55.6617123, 12.5736, 3.5, 271.25};
  const auto json = nlohmann::json::parse(toJson(s));
  EXPECT_EQ(json["gnss"]["spans"][0]["from_utc"], "2024-12-05T12:00:30.000Z");
  core::writeTextFile(folder.file("summary.json"), toJson(s));
  const auto back = readSummary(folder.file("summary.json")).gnss;
  ASSERT_TRUE(back);
  EXPECT_TRUE(back->distrusted);
  EXPECT_EQ(back->unbelievable, 31U);
  ASSERT_EQ(back->spans.size(), 1U);
  EXPECT_EQ(back->spans[0].from, gnss.spans[0].from);
  EXPECT_EQ(back->spans[0].to, gnss.spans[0].to);
  ASSERT_TRUE(back->mapOrigin);
  EXPECT_EQ(back->mapOrigin->latitude_deg, 55.6617123);
  EXPECT_FALSE(readSummary(folder.file("summary.json")).gnss->state.empty());
}

TEST(RunSummary, NoGnss_IsNull) { EXPECT_TRUE(nlohmann::json::parse(toJson(RunSummary{}))["gnss"].is_null()); }

TEST(RunSummary, UnknownWaterAndNoTime_AreNullAndZero) {
  const auto json = nlohmann::json::parse(toJson(RunSummary{}));
  EXPECT_TRUE(json["water_height_m"].is_null());
  EXPECT_EQ(json["realtime_factor"], 0);
}

TEST(RunSummary, BrokenUtf8InNames_StillGivesValidJson) {
  RunSummary s;
  s.inputs = {"bad\xff.rawlog"};
  EXPECT_NO_THROW(nlohmann::json::parse(toJson(s)));
}

TEST(RunSummary, File_ReadsBack) {
  const TempFolder folder;
  const RunSummary s = sampleSummary();
  core::writeTextFile(folder.file("summary.json"), toJson(s));
  const RunSummary back = readSummary(folder.file("summary.json"));
  EXPECT_EQ(back.inputs, s.inputs);
  EXPECT_EQ(back.startTime, s.startTime);
  EXPECT_EQ(back.points, s.points);
  EXPECT_EQ(back.keyframes, s.keyframes);
  EXPECT_EQ(back.waterHeight_m, s.waterHeight_m);
  EXPECT_EQ(back.warnings, s.warnings);
  EXPECT_EQ(back.stageTimes_s, s.stageTimes_s);
  ASSERT_EQ(back.figures.size(), 2U);
  EXPECT_EQ(back.figures[0], s.figures[0]);
  EXPECT_TRUE(std::isnan(back.figures[1].second));
}

TEST(RunSummary, BadFile_IsAnInputErrorWithThePlace) {
  const TempFolder folder;
  writeBytes(folder.file("cut.json"), "{\"sweeps\": 3, ");
  EXPECT_THAT(errorText<core::InputError>([&] { readSummary(folder.file("cut.json")); }), HasSubstr("byte 1"));
  writeBytes(folder.file("kind.json"), "{\"sweeps\": \"many\"}");
  EXPECT_THAT(errorText<core::InputError>([&] { readSummary(folder.file("kind.json")); }), HasSubstr("wrong kind"));
  EXPECT_THROW(readSummary(folder.file("absent.json")), core::InputError);
}

}  // namespace
}  // namespace s2s::products
