#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "s2s/core/error.h"
#include "s2s/mapper/survey_config.h"
#include "temp_folder.h"

namespace s2s::mapper {
namespace {

using ::testing::HasSubstr;

/// Each test has a folder of its own: CTest runs the tests side by side, each in its own process.
class SurveyConfigText : public ::testing::Test {
 protected:
  std::string write(const std::string& text) const {
    test::writeBytes(folder_.file("survey.ini"), text);
    return folder_.file("survey.ini");
  }

 private:
  test::TempFolder folder_;
};

TEST(SurveyConfig, EveryShippedFile_Loads) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(S2S_SOURCE_DIR) + "/ini")) {
    if (entry.path().extension() != ".ini") continue;
    EXPECT_NO_THROW(loadSurveyConfig(entry.path().string())) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 2);
}

TEST_F(SurveyConfigText, Printed_ReadsBackToTheSame) {
  SurveyConfig config;
  config.mapper.lidar.label = "OS1";
  config.mapper.lidar.T_vehicle_sensor = core::isometryFromXyzYpr(1, 2, 3, 0.5, 0.25, -0.125);
  config.odometry.scan.hullBox = {-1, -2, -3, 1, 2, 3};
  config.graph.loops.radius_m = 7.5;
  const std::string text = printSurveyConfig(config);
  EXPECT_EQ(printSurveyConfig(loadSurveyConfig(write(text))), text);
}

TEST_F(SurveyConfigText, MisspelledKey_ErrorNamesTheNearest) {
  try {
    loadSurveyConfig(write("[mapper]\nlabel_lider = X\n"));
    FAIL() << "no error";
  } catch (const core::ConfigError& e) {
    EXPECT_THAT(e.where(), HasSubstr(":2"));
    EXPECT_THAT(e.remedy(), HasSubstr("label_lidar"));
  }
}

TEST_F(SurveyConfigText, Waterline_IsToldToTheMapToo) {
  EXPECT_EQ(loadSurveyConfig(write("[mapper]\nwaterline_m = -1.9\n")).map.waterline_m, -1.9);
}

TEST_F(SurveyConfigText, Override_ReplacesTheFilesValue) {
  const auto path = write("[sonar.vertical.leading_edge]\nthreshold = 100\n");
  const auto config = loadSurveyConfig(path, {"sonar.vertical.leading_edge.threshold=90"});
  EXPECT_EQ(config.sonar.vertical.leadingEdge.threshold, 90);
}

TEST(SurveyConfig, OverrideWithoutSection_IsRefused) {
  EXPECT_THROW(loadSurveyConfig("", {"threshold=90"}), core::ConfigError);
  EXPECT_THROW(loadSurveyConfig("", {"mapper.on_water"}), core::ConfigError);
}

TEST(SurveyConfig, MissingFile_IsAConfigError) {
  EXPECT_THROW(loadSurveyConfig("/no/such/file.ini"), core::ConfigError);
}

}  // namespace
}  // namespace s2s::mapper
