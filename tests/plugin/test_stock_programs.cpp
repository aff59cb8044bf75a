#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/io/CFileInputStream.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/system/os.h>

#include <array>
#include <cstdio>
#include <cstdlib>

#include "plugin_support.h"

namespace {

using namespace s2s::test;
using testing::HasSubstr;
using testing::Not;

/// Why a stock program cannot be tried here; empty if it can.
std::string obstacle([[maybe_unused]] const std::string& program) {
#ifdef __SANITIZE_ADDRESS__
  return "a stock program cannot load a plugin built with the address sanitizer";
#else
  if (std::system(("command -v " + program + " > /dev/null 2>&1").c_str()) == 0) return "";
  return program + " (package mrpt-apps) is not installed";
#endif
}

/// Runs a command line and returns all it prints; stdin is closed, since MRPT's programs may wait for a key.
std::string outputOf(const std::string& command) {
  std::string output;
  FILE* pipe = popen((command + " < /dev/null 2>&1").c_str(), "r");
  if (!pipe) return "cannot run " + command;
  std::array<char, 4096> buffer{};
  while (std::fgets(buffer.data(), static_cast<int>(buffer.size()), pipe)) output += buffer.data();
  pclose(pipe);
  return output;
}

TEST(RawlogEdit, Info_NamesBothSensors) {
  if (const auto why = obstacle("rawlog-edit"); !why.empty()) GTEST_SKIP() << why;
  const TempFolder folder;
  writeSurvey(folder.file("survey.rawlog"));
  const std::string text =
      outputOf("rawlog-edit -p " + pluginPath() + " -i " + folder.file("survey.rawlog") + " --info");
  EXPECT_THAT(text, HasSubstr("LIDAR, SONAR_HORIZONTAL"));
  EXPECT_THAT(text, HasSubstr("Overall number of objects         : 2"));
  EXPECT_THAT(text, Not(HasSubstr("not registered")));
}

TEST(RawlogEdit, Describe_PrintsBothRecords) {
  if (const auto why = obstacle("rawlog-edit"); !why.empty()) GTEST_SKIP() << why;
  const TempFolder folder;
  writeSurvey(folder.file("survey.rawlog"));
  const std::string text =
      outputOf("rawlog-edit -p " + pluginPath() + " -i " + folder.file("survey.rawlog") + " --describe");
  EXPECT_THAT(text, HasSubstr("Imaging sonar ping"));
  EXPECT_THAT(text, HasSubstr("LiDAR sweep"));
}

TEST(RawlogEdit, WithoutThePlugin_DoesNotKnowThem) {
  if (const auto why = obstacle("rawlog-edit"); !why.empty()) GTEST_SKIP() << why;
  const TempFolder folder;
  writeSurvey(folder.file("survey.rawlog"));
  EXPECT_THAT(outputOf("rawlog-edit -i " + folder.file("survey.rawlog") + " --info"), HasSubstr("not registered"));
}

/// A simple map of one place with one of our sweeps, as MRPT's mapping programs take it.
void writeSimpleMap(const std::string& path) {
  std::string error;
  ASSERT_TRUE(mrpt::system::loadPluginModule(pluginPath(), error)) << error;
  mrpt::io::CFileInputStream file(dataFile("obs_version_0/lidar_sweep.rawlog"));
  auto archive = mrpt::serialization::archiveFrom(file);
  mrpt::obs::CSensoryFrame frame;
  frame.insert(std::dynamic_pointer_cast<mrpt::obs::CObservation>(archive.ReadObject()));
  mrpt::maps::CSimpleMap places;
  places.insert(mrpt::poses::CPose3DPDFGaussian(mrpt::poses::CPose3D(1, 2, 3, 0, 0, 0)), frame);
  ASSERT_TRUE(places.saveToFile(path));
}

TEST(Observations2map, PluginPreloaded_BuildsAndSavesOurMap) {
  if (const auto why = obstacle("observations2map"); !why.empty()) GTEST_SKIP() << why;
  const TempFolder folder;
  writeSimpleMap(folder.file("in.simplemap"));
  writeBytes(folder.file("map.ini"),
             "[map]\nseabedSkyMap_count = 1\n\n[map_seabedSkyMap_00_insertOpts]\nlidar_min_range_m = 0\n");
  const std::string text = outputOf("LD_PRELOAD=" + pluginPath() + " observations2map " + folder.file("map.ini") + " " +
                                    folder.file("in.simplemap") + " " + folder.file("out") + " -s map");
  EXPECT_TRUE(std::filesystem::exists(folder.file("out_s2s__map__CSeabedSkyMap_00.3Dscene"))) << text;
  EXPECT_TRUE(std::filesystem::exists(folder.file("out_s2s__map__CSeabedSkyMap_00_lidar.txt"))) << text;
}

}  // namespace
