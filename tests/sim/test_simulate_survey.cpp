#include <gtest/gtest.h>
#include <sys/wait.h>

#include "s2s/core/ini_file.h"
#include "s2s/obs/rawlog_reader.h"
#include "temp_folder.h"

using namespace s2s;
using namespace s2s::test;

namespace {

/// A scene small enough that the program runs in a moment.
const char kScene[] =
    "[scene]\nname = tiny\n[seabed]\nheight_m = -3\n"
    "[object.seabed]\nshape = terrain\nkind = seabed\nmaterial = sand\nmin_x_m = -30\nmax_x_m = 40\nmin_y_m = -30\n"
    "max_y_m = 30\nresolution_m = 1\n"
    "[object.quay]\nshape = box\npose = 10 8 0 0 0 0\nsize_x_m = 40\nsize_y_m = 1\nsize_z_m = 8\n"
    "[vessel_part.hull]\nshape = box\nsize_x_m = 2\nsize_y_m = 1\nsize_z_m = 0.4\n"
    "[experiment.1]\ndescription = straight\nwaypoints_m = 0 0 30 0\n"
    "[sonar.horizontal]\nbeams = 32\nrange_bins = 100\n[sonar.vertical]\nbeams = 16\nrange_bins = 100\n";

class SimulateSurvey : public testing::Test {
 protected:
  SimulateSurvey() { std::ofstream(scene()) << kScene; }
  std::string scene() const { return folder_.file("tiny.ini"); }
  std::string output() const { return folder_.file("out"); }
  /// Runs the program and returns its exit code; its messages are in `log()`.
  int run(const std::string& arguments) const {
    const std::string command =
        std::string(S2S_BIN_DIR) + "/simulate-survey " + arguments + " >" + folder_.file("log") + " 2>&1";
    return WEXITSTATUS(std::system(command.c_str()));
  }
  int runScene(const std::string& arguments) const {
    return run("--scene " + scene() + " --output " + output() + " --lidar 8x64@10 " + arguments);
  }
  std::string log() const { return readBytes(folder_.file("log")); }

  TempFolder folder_;
};

}  // namespace

TEST_F(SimulateSurvey, WritesARawlogWithAllSensors_TheTruth_AndTheSurveyorsConfiguration) {
  ASSERT_EQ(runScene("--duration 2"), 0) << log();
  const auto summary = obs::summarizeRawlog(output() + "/survey.rawlog");
  EXPECT_TRUE(summary.faults.empty());
  EXPECT_EQ(summary.backwards, 0u);
  EXPECT_EQ(summary.sensors.size(), 5u);
  EXPECT_EQ(summary.sensors.at("IMU").count, 200u);
  EXPECT_EQ(summary.sensors.at("LIDAR").className, "s2s::obs::CObservationLidarSweep");
  for (const char* file : {"trajectory.tum", "world.ply", "objects.csv", "seabed.asc", "extrinsics.ini",
                           "control_points.csv", "returns_SONAR_HORIZONTAL.bin", "returns_SONAR_VERTICAL.bin"})
    EXPECT_TRUE(std::filesystem::exists(output() + "/truth/" + file)) << file;
  core::IniFile survey = core::IniFile::load(output() + "/survey.ini");
  EXPECT_EQ(survey.read("mapper", "label_lidar")->value, "LIDAR");
  EXPECT_EQ(survey.read("mapper", "pose_sonar_vertical")->value, "-1.13 -0.14 -0.58 0 45 90");
  EXPECT_EQ(survey.read("odometry", "hull_box")->value, "-1.1 -0.6 -0.3 1.1 0.6 0.3");
}

TEST_F(SimulateSurvey, SameSeed_SameBytes) {
  ASSERT_EQ(runScene("--duration 1 --seed 5 --threads 1"), 0) << log();
  const std::string first = readBytes(output() + "/survey.rawlog");
  ASSERT_EQ(runScene("--duration 1 --seed 5 --threads 2"), 0) << log();
  EXPECT_EQ(first, readBytes(output() + "/survey.rawlog"));
}

TEST_F(SimulateSurvey, CutRawlog_EndsWithinARecord) {
  ASSERT_EQ(runScene("--duration 1 --set faults.cut_bytes=100"), 0) << log();
  const auto summary = obs::summarizeRawlog(output() + "/survey.rawlog");
  ASSERT_EQ(summary.faults.size(), 1u);
  EXPECT_EQ(summary.faults[0].kind, obs::RawlogFault::Kind::TruncatedEnd);
}

TEST_F(SimulateSurvey, ClockJumpingBackwards_IsRecordedAsItCame) {
  ASSERT_EQ(runScene("--duration 2 --set faults.clock_jump_at_s=1 --set faults.clock_jump_s=-30"), 0) << log();
  EXPECT_GE(obs::summarizeRawlog(output() + "/survey.rawlog").backwards, 1u);
}

TEST_F(SimulateSurvey, SensorSwitchedOff_IsAbsent) {
  ASSERT_EQ(runScene("--duration 1 --set gnss.enabled=false --set sonar.vertical.enabled=false"), 0) << log();
  const auto summary = obs::summarizeRawlog(output() + "/survey.rawlog");
  EXPECT_EQ(summary.sensors.count("GNSS"), 0u);
  EXPECT_EQ(summary.sensors.count("SONAR_VERTICAL"), 0u);
}

TEST_F(SimulateSurvey, WrongUse_ExitsWith2_AndSaysWhatToDo) {
  EXPECT_EQ(run(""), 2);
  EXPECT_NE(log().find("--scene"), std::string::npos);
  EXPECT_EQ(run("--scene " + folder_.file("none.ini") + " --output x"), 2);
  EXPECT_EQ(run("--scene " + scene()), 2);
  EXPECT_NE(log().find("--output"), std::string::npos);
  EXPECT_EQ(runScene("--experiment 9"), 2);
  EXPECT_NE(log().find("1  straight"), std::string::npos);
  EXPECT_EQ(runScene("--set lidar.rowz=3"), 2);
  EXPECT_NE(log().find("rows"), std::string::npos);
  EXPECT_EQ(runScene("--lidar 64"), 2);
}

TEST_F(SimulateSurvey, ListOptions_PrintsEverySettingAndSimulatesNothing) {
  ASSERT_EQ(run("--scene " + scene() + " --list-options"), 0) << log();
  EXPECT_NE(log().find("[sonar.vertical]"), std::string::npos);
  EXPECT_NE(log().find("cross_talk_share"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(output()));
}
