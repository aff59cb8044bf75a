#include <gtest/gtest.h>
#include <sys/wait.h>

#include <filesystem>
#include <fstream>

#include "s2s/core/time.h"
#include "s2s/obs/rawlog_writer.h"
#include "synthetic_pings.h"
#include "temp_folder.h"

namespace s2s::sonar {
namespace {

namespace fs = std::filesystem;
using s2s::test::TempFolder;

/// Exit status of the program with these arguments.
int runInspect(const std::string& arguments) {
  const std::string command = std::string(S2S_BIN_DIR) + "/sonar-inspect " + arguments + " > /dev/null 2>&1";
  return WEXITSTATUS(std::system(command.c_str()));  // NOLINT(cert-env33-c): a program of our own, fixed arguments
}

/// Two pings of each sonar asked for.
std::string writeLog(const TempFolder& folder, bool horizontal, bool vertical) {
  std::string path = folder.file("survey.rawlog");
  const test::TwinSonars twins;
  const auto seabed = test::levelSeabed(3.0);
  obs::RawlogWriter writer(path);
  for (int i = 0; i < 2; ++i) {
    const auto add = [&](obs::CObservationImagingSonar ping, const char* label, const core::Isometry& pose, int ms) {
      ping.sensorLabel = label;
      ping.sensorPose = core::toPose(pose);
      ping.timestamp = core::toMrptTime((1733400000LL * 1000 + 100 * i + ms) * 1000000);
      writer.write(std::make_shared<obs::CObservationImagingSonar>(ping));
    };
    if (horizontal) add(twins.horizontalPing(seabed), "SONAR_HORIZONTAL", twins.T_level_h, 0);
    if (vertical) add(twins.verticalPing(seabed), "SONAR_VERTICAL", twins.T_level_v, 20);
  }
  writer.close();
  return path;
}

TEST(SonarInspect, PairOfSonars_GivesAPictureOfEveryStage) {
  const TempFolder folder;
  const std::string out = folder.file("pictures");
  ASSERT_EQ(runInspect(writeLog(folder, true, true) + " --ping 1 --output " + out), 0);
  for (const char* name :
       {"horizontal_0_raw_polar.png", "horizontal_4_opening_cartesian.png", "horizontal_5_leading_edge_cartesian.png",
        "vertical_2_center_removal_polar.png", "vertical_5_leading_edge_polar.png", "horizontal_features_polar.png",
        "vertical_clusters_cartesian.png", "stereo_matches.png", "stereo_points.png", "effective.ini"})
    EXPECT_TRUE(fs::exists(out + "/" + name)) << name;
  EXPECT_EQ(runInspect(folder.file("survey.rawlog") + " --output " + out + " --config " + out + "/effective.ini"), 0);
}

TEST(SonarInspect, OneSonarOnly_IsInspectedAlone) {
  const TempFolder folder;
  const std::string log = writeLog(folder, false, true);
  ASSERT_EQ(runInspect(log + " --output " + folder.file("pictures")), 0);
  EXPECT_TRUE(fs::exists(folder.file("pictures") + "/vertical_5_leading_edge_cartesian.png"));
  EXPECT_FALSE(fs::exists(folder.file("pictures") + "/stereo_matches.png"));
}

TEST(SonarInspect, WrongInput_HasItsExitCode) {
  const TempFolder folder;
  const std::string log = writeLog(folder, true, false);
  EXPECT_EQ(runInspect(log + " --ping 7 --output " + folder.file("x")), 3);
  EXPECT_EQ(runInspect(folder.file("none.rawlog") + " --output " + folder.file("x")), 3);
  EXPECT_EQ(runInspect(log), 2);
  EXPECT_EQ(runInspect(log + " --output " + folder.file("x") + " --config " + folder.file("none.ini")), 2);
}

TEST(SonarInspect, MapperConfigurationIsTaken_MisspelledSonarKeyIsRefused) {
  const TempFolder folder;
  const std::string log = writeLog(folder, true, false);
  const auto inspectWith = [&](const std::string& text) {
    std::ofstream(folder.file("c.ini")) << text;
    return runInspect(log + " --output " + folder.file("x") + " --config " + folder.file("c.ini"));
  };
  EXPECT_EQ(inspectWith("[mapper]\nsonar_horizontal = SONAR_HORIZONTAL\n"), 0);
  EXPECT_EQ(inspectWith("[sonar.detection]\nno_such_key = 1\n"), 2);
}

}  // namespace
}  // namespace s2s::sonar
