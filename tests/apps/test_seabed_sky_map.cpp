#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "s2s/obs/rawlog_writer.h"
#include "s2s/sim/scene_loader.h"
#include "s2s/sim/survey_simulator.h"
#include "temp_folder.h"

namespace s2s {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

namespace fs = std::filesystem;

constexpr double kDuration_s = 4.0;

/// Four seconds of the canal as a rawlog with its configuration, written once for all tests.
class SeabedSkyMap : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new test::TempFolder;
    auto ini = core::IniFile::load(std::string(S2S_SOURCE_DIR) + "/share/scenes/canal.ini");
    const auto scene = sim::loadScene(ini);
    sim::SimulationOptions options;
    options.duration_s = kDuration_s;
    obs::RawlogWriter writer(folder_->file("survey.rawlog"));
    sim::SimulationSinks sinks;
    sinks.record = [&writer](const mrpt::obs::CObservation::Ptr& record) { writer.write(record); };
    sim::SurveySimulator(scene, 1, options).run(sinks);
    writer.close();
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }

  struct Outcome {
    int exitCode = -1;
    std::string text;  // stdout and stderr
  };
  static Outcome run(const std::string& arguments) {
    const std::string log = folder_->file("log.txt");
    const int status =
        std::system((std::string(S2S_BIN_DIR) + "/seabed-sky-map " + arguments + " >" + log + " 2>&1").c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, test::readBytes(log)};
  }
  static std::string survey() { return folder_->file("survey.rawlog"); }
  static std::string config() { return std::string(S2S_SOURCE_DIR) + "/ini/asv.ini"; }
  static nlohmann::json summaryOf(const std::string& output) {
    return nlohmann::json::parse(test::readBytes(output + "/summary.json"));
  }

  static test::TempFolder* folder_;
};
test::TempFolder* SeabedSkyMap::folder_ = nullptr;

TEST_F(SeabedSkyMap, WholeSurvey_WritesEveryProductAndTheSummary) {
  const std::string output = folder_->file("map");
  const auto outcome = run(survey() + " --config " + config() + " --output " + output);
  ASSERT_EQ(outcome.exitCode, 0) << outcome.text;
  EXPECT_THAT(outcome.text, HasSubstr("x real time"));
  for (const char* name : {"trajectory.tum", "odometry.tum", "keyframes.tum", "lidar.ply", "stereo.ply",
                           "line_horizontal.ply", "line_vertical.ply", "map.las", "seabed.tif", "seabed.bag",
                           "graph.graph", "graph.g2o", "map.3Dscene", "map.png", "effective.ini", "report.html"})
    EXPECT_TRUE(fs::exists(output + "/" + name)) << name;
  const auto summary = summaryOf(output);
  for (const char* key : {"duration_s", "wall_s", "realtime_factor", "sweeps", "pings_horizontal", "pings_vertical",
                          "keyframes", "loop_closures", "points", "peak_rss_mb", "warnings"})
    EXPECT_TRUE(summary.contains(key)) << key;
  // Rates of 10, 15 and 10 Hz; the first and last record of each may fall on either side of the end.
  EXPECT_NEAR(summary["sweeps"].get<double>(), 10 * kDuration_s, 1);
  EXPECT_NEAR(summary["pings_horizontal"].get<double>(), 15 * kDuration_s, 1);
  EXPECT_NEAR(summary["pings_vertical"].get<double>(), 10 * kDuration_s, 1);
  for (const char* layer : {"lidar", "stereo", "line_horizontal", "line_vertical"})
    EXPECT_GT(summary["points"][layer].get<double>(), 0) << layer;
}

TEST_F(SeabedSkyMap, EffectiveConfiguration_GivesTheSameRunAgain) {
  const std::string first = folder_->file("first"), second = folder_->file("second");
  const std::string rest = " --threads 1 --quiet --set products.las=false --output ";
  ASSERT_EQ(run(survey() + " --config " + config() + rest + first).exitCode, 0);
  ASSERT_EQ(run(survey() + " --config " + first + "/effective.ini" + rest + second).exitCode, 0);
  for (const char* name : {"trajectory.tum", "lidar.ply", "stereo.ply", "effective.ini"})
    EXPECT_TRUE(test::readBytes(first + "/" + name) == test::readBytes(second + "/" + name)) << name;
}

TEST_F(SeabedSkyMap, PartOfTheSurvey_MapsOnlyThat) {
  const std::string output = folder_->file("part");
  ASSERT_EQ(run(survey() + " --config " + config() + " --from 1 --to 3 --quiet --output " + output).exitCode, 0);
  EXPECT_NEAR(summaryOf(output)["duration_s"].get<double>(), 2.0, 0.1);  // a sweep's period
}

TEST_F(SeabedSkyMap, TruncatedRawlog_MapsWhatIsThereAndSaysSo) {
  const std::string cut = folder_->file("cut.rawlog"), output = folder_->file("cut");
  fs::copy_file(survey(), cut);
  // Not at three quarters sharp: records come so evenly that this is the end of one.
  fs::resize_file(cut, fs::file_size(cut) * 3 / 4 - 1000);
  const auto outcome = run(cut + " --config " + config() + " --output " + output);
  EXPECT_EQ(outcome.exitCode, 0) << outcome.text;
  EXPECT_THAT(outcome.text, HasSubstr("ends within a record"));
  EXPECT_FALSE(summaryOf(output)["warnings"].empty());
}

TEST_F(SeabedSkyMap, WrongUsage_ExitsWithTwo) {
  EXPECT_EQ(run("").exitCode, 2);
  EXPECT_EQ(run("--no-such-option").exitCode, 2);
  EXPECT_EQ(run(survey() + " --output " + folder_->file("x")).exitCode, 2);
  EXPECT_EQ(run(survey() + " --config /no/such.ini --output " + folder_->file("x")).exitCode, 2);
  const auto outcome =
      run(survey() + " --config " + config() + " --set mapper.label_lider=X --output " + folder_->file("x"));
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.text, HasSubstr("label_lidar"));
}

TEST_F(SeabedSkyMap, UnusableInput_ExitsWithThree) {
  const std::string rest = " --config " + config() + " --output " + folder_->file("x");
  EXPECT_EQ(run("/no/such.rawlog" + rest).exitCode, 3);
  EXPECT_EQ(run(config() + rest).exitCode, 3);
  const auto outcome = run(survey() + rest + " --set mapper.label_lidar=OS2");
  EXPECT_EQ(outcome.exitCode, 3);
  EXPECT_THAT(outcome.text, HasSubstr("'LIDAR'"));
}

TEST_F(SeabedSkyMap, OutputThatCannotBeWritten_ExitsWithFourBeforeMapping) {
  const auto outcome = run(survey() + " --config " + config() + " --output " + survey() + "/x");
  EXPECT_EQ(outcome.exitCode, 4) << outcome.text;
  EXPECT_THAT(outcome.text, Not(HasSubstr("Mapping: 100 %")));
}

TEST_F(SeabedSkyMap, HelpAndPrintedConfiguration_ExitWithZero) {
  EXPECT_THAT(run("--help").text, HasSubstr("--print-config"));
  const auto outcome = run("--print-config");
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_THAT(outcome.text, HasSubstr("[sonar.stereo]"));
}

}  // namespace
}  // namespace s2s
