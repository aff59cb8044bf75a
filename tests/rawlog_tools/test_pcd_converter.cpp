#include "pcd2rawlog/pcd_converter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <filesystem>

#include "s2s/core/error.h"
#include "s2s/obs/rawlog_reader.h"
#include "temp_folder.h"

using namespace s2s;
using namespace s2s::tools;
using mrpt::obs::CObservationPointCloud;
using testing::ElementsAre;
using testing::HasSubstr;

namespace {

std::string onePoint(float x) {
  return "FIELDS x y z intensity time\nSIZE 4 4 4 4 8\nTYPE F F F F F\nWIDTH 1\nHEIGHT 1\nDATA ascii\n" +
         std::to_string(x) + " 2 3 0.25 9\n";
}

std::vector<CObservationPointCloud::Ptr> cloudsIn(const std::string& path) {
  std::vector<CObservationPointCloud::Ptr> clouds;
  obs::RawlogReader reader(path);
  while (const auto observation = reader.next())
    clouds.push_back(std::dynamic_pointer_cast<CObservationPointCloud>(observation));
  return clouds;
}

class PcdConverter : public testing::Test {
 protected:
  PcdConverter() {
    options_.output = out_.file("a.rawlog");
    options_.label = "LIDAR";
  }
  test::TempFolder in_, out_;
  ConverterOptions options_;
};

}  // namespace

TEST_F(PcdConverter, NumberedFiles_ComeInNaturalOrder) {
  for (const char* name : {"scan10.pcd", "scan2.pcd", "scan1.PCD", "scan02b.pcd", "notes.txt"})
    test::writeBytes(in_.file(name), "");
  std::vector<std::string> names;
  for (const auto& path : pcd::listPcdFiles(in_.path())) names.push_back(std::filesystem::path(path).filename());
  EXPECT_THAT(names, ElementsAre("scan1.PCD", "scan2.pcd", "scan02b.pcd", "scan10.pcd"));
}

TEST_F(PcdConverter, Scans_GetTimesPoseAndIntensity) {
  test::writeBytes(in_.file("1.pcd"), onePoint(1));
  test::writeBytes(in_.file("2.pcd"), onePoint(2));
  options_.startTime = 1'700'000'000'000'000'000;
  options_.T_vehicle_sensor = core::isometryFromXyzYpr(0, 0, 1.73, 0, 0, 0);
  const auto report = pcd::convertPcdFolder(in_.path(), 20, options_);
  EXPECT_EQ(report.readCount("scans"), 2u);
  EXPECT_THAT(report.text(), HasSubstr("2 files' field 'time'"));
  const auto clouds = cloudsIn(options_.output);
  ASSERT_EQ(clouds.size(), 2u);
  EXPECT_EQ(core::fromMrptTime(clouds[1]->timestamp), 1'700'000'000'050'000'000);
  EXPECT_EQ(clouds[1]->sensorPose.z(), 1.73);
  const auto points = std::dynamic_pointer_cast<mrpt::maps::CPointsMapXYZI>(clouds[1]->pointcloud);
  ASSERT_NE(points, nullptr);
  ASSERT_EQ(points->size(), 1u);
  EXPECT_EQ(points->getPointsBufferRef_x()[0], 2);
  EXPECT_EQ(points->getPointIntensity(0), 0.25f);
}

TEST_F(PcdConverter, DamagedFile_IsSkippedAndItsTimeStaysEmpty) {
  test::writeBytes(in_.file("1.pcd"), onePoint(1));
  test::writeBytes(in_.file("2.pcd"), "rubbish");
  test::writeBytes(in_.file("3.pcd"), onePoint(3));
  const auto report = pcd::convertPcdFolder(in_.path(), 10, options_);
  EXPECT_THAT(report.text(), HasSubstr("files that cannot be used: the header has no DATA line"));
  EXPECT_THAT(report.text(), HasSubstr("2.pcd"));
  const auto clouds = cloudsIn(options_.output);
  ASSERT_EQ(clouds.size(), 2u);
  EXPECT_EQ(core::fromMrptTime(clouds[1]->timestamp), kDefaultStartTime + 200'000'000);
}

TEST_F(PcdConverter, NothingUsable_IsRefusedAndLeavesNoFile) {
  EXPECT_THROW(pcd::convertPcdFolder(in_.path(), 10, options_), core::InputError);
  EXPECT_THROW(pcd::convertPcdFolder("/nowhere", 10, options_), core::InputError);
  test::writeBytes(in_.file("1.pcd"), "rubbish");
  EXPECT_THROW(pcd::convertPcdFolder(in_.path(), 10, options_), core::InputError);
  EXPECT_THROW(pcd::convertPcdFolder(in_.path(), 0, options_), core::ConfigError);
  EXPECT_EQ(out_.fileCount(), 0u);
}

TEST_F(PcdConverter, RealScans_AllBecomeClouds) {
  const std::string folder = std::string(S2S_DATA_DIR) + "/kitti_scans";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  const auto report = pcd::convertPcdFolder(folder, 10, options_);
  EXPECT_EQ(report.readCount("scans"), 22u);
  EXPECT_TRUE(report.skipped().empty());
  const auto clouds = cloudsIn(options_.output);
  ASSERT_EQ(clouds.size(), 22u);
  EXPECT_EQ(clouds[0]->pointcloud->size(), 119'978u);
  for (const auto& cloud : clouds) {
    const auto box = cloud->pointcloud->boundingBox();
    // A Velodyne HDL-64E sees to 120 m, and the street is some 1.7 m below it.
    EXPECT_LT(box.max.norm(), 150);
    EXPECT_LT(box.min.z, -1.5f);
  }
}
