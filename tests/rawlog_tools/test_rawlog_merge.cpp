#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/io/CFileOutputStream.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/serialization/CArchive.h>

#include <filesystem>

#include "rawlog-merge/rawlog_merger.h"
#include "s2s/core/error.h"
#include "s2s/core/time.h"
#include "s2s/obs/rawlog_reader.h"
#include "temp_folder.h"

using namespace s2s;
using core::TimeNs;
using testing::ElementsAre;
using testing::HasSubstr;
using tools::merge::mergeRawlogs;

namespace {

constexpr TimeNs kStart = 1'700'000'000'000'000'000;
constexpr TimeNs kMs = 1'000'000;

class RawlogMerge : public testing::Test {
 protected:
  RawlogMerge() { options_.output = folder_.file("out.rawlog"); }

  /// Writes IMU records at these milliseconds, in this order, with stock MRPT.
  std::string input(const std::string& name, const std::string& label, const std::vector<TimeNs>& times_ms) {
    mrpt::io::CFileOutputStream file(folder_.file(name));
    auto archive = mrpt::serialization::archiveFrom(file);
    for (const TimeNs ms : times_ms) {
      mrpt::obs::CObservationIMU imu;
      imu.timestamp = core::toMrptTime(kStart + ms * kMs);
      imu.sensorLabel = label;
      archive << imu;
    }
    options_.inputs.push_back(folder_.file(name));
    return folder_.file(name);
  }

  /// "label milliseconds" of each record of the output.
  std::vector<std::string> output() const {
    std::vector<std::string> lines;
    obs::RawlogReader reader(options_.output);
    while (const auto observation = reader.next())
      lines.push_back(observation->sensorLabel + " " +
                      std::to_string((core::fromMrptTime(observation->timestamp) - kStart) / kMs));
    EXPECT_TRUE(reader.faults().empty());
    return lines;
  }

  test::TempFolder folder_;
  tools::merge::MergeOptions options_;
};

}  // namespace

TEST_F(RawlogMerge, ThreeInputs_AreInterleavedByTime) {
  input("a", "A", {0, 30, 60});
  input("b", "B", {10, 20, 70});
  input("c", "C", {30});
  const auto report = mergeRawlogs(options_);
  EXPECT_THAT(output(), ElementsAre("A 0", "B 10", "B 20", "A 30", "C 30", "A 60", "B 70"));
  EXPECT_EQ(report.readCount("observations of B"), 3u);
}

TEST_F(RawlogMerge, Offsets_ShiftTheirInputOnly) {
  input("a", "A", {0, 30});
  input("b", "B", {10, 20});
  options_.offset_s[1] = -0.015;
  mergeRawlogs(options_);
  EXPECT_THAT(output(), ElementsAre("B -5", "A 0", "B 5", "A 30"));
}

TEST_F(RawlogMerge, InputOutOfOrderWithinTheWindow_IsSorted) {
  input("a", "A", {0, 50, 20, 100});
  input("b", "B", {30, 10});
  mergeRawlogs(options_);
  EXPECT_THAT(output(), ElementsAre("A 0", "B 10", "A 20", "B 30", "A 50", "A 100"));
}

TEST_F(RawlogMerge, OutOfOrderBeyondTheWindow_IsSkippedAndCounted) {
  input("a", "A", {0, 500, 1000, 100, 1100});
  options_.reorderWindow_s = 0.2;
  const auto report = mergeRawlogs(options_);
  EXPECT_THAT(output(), ElementsAre("A 0", "A 500", "A 1000", "A 1100"));
  EXPECT_THAT(report.text(), HasSubstr("1 records that are out of order by more than 200 ms"));
}

TEST_F(RawlogMerge, TimeFarAhead_CostsOnlyItsOwnRecord) {
  input("a", "A", {0, 10, 365LL * 86'400'000, 20, 30});
  input("b", "B", {15, 25});
  const auto report = mergeRawlogs(options_);
  EXPECT_THAT(output(), ElementsAre("A 0", "A 10", "B 15", "A 20", "B 25", "A 30"));
  EXPECT_EQ(report.skippedCount("records more than an hour ahead of the one behind them"), 1u);
}

TEST_F(RawlogMerge, PauseOfDays_IsKept) {
  input("a", "A", {0, 2 * 86'400'000LL, 2 * 86'400'000LL + 10});
  mergeRawlogs(options_);
  EXPECT_THAT(output(), ElementsAre("A 0", "A 172800000", "A 172800010"));
}

TEST_F(RawlogMerge, LabelsAndPoses_AreChanged) {
  input("a", "A", {0});
  input("b", "B", {1});
  options_.newLabel["B"] = "IMU2";
  options_.T_vehicle_sensor["IMU2"] = core::isometryFromXyzYpr(1, 2, 3, 0, 0, 0);
  mergeRawlogs(options_);
  obs::RawlogReader reader(options_.output);
  mrpt::poses::CPose3D pose;
  reader.next()->getSensorPose(pose);
  EXPECT_EQ(pose.x(), 0);
  const auto second = reader.next();
  EXPECT_EQ(second->sensorLabel, "IMU2");
  second->getSensorPose(pose);
  EXPECT_EQ(pose.x(), 1);
}

TEST_F(RawlogMerge, LabelThatIsNowhere_IsRefusedAndLeavesNoFile) {
  input("a", "A", {0});
  options_.newLabel["X"] = "Y";
  EXPECT_THROW(mergeRawlogs(options_), core::ConfigError);
  EXPECT_FALSE(std::filesystem::exists(options_.output));
}

TEST_F(RawlogMerge, RecordsWithoutTimeOrLabel_AreToldApart) {
  {
    mrpt::io::CFileOutputStream file(folder_.file("a"));
    auto archive = mrpt::serialization::archiveFrom(file);
    mrpt::obs::CObservationIMU imu;
    imu.timestamp = INVALID_TIMESTAMP;
    archive << imu;
    imu.timestamp = core::toMrptTime(kStart);
    archive << imu;
  }
  options_.inputs = {folder_.file("a")};
  const auto report = mergeRawlogs(options_);
  EXPECT_EQ(report.skippedCount("records without a usable time"), 1u);
  EXPECT_THAT(output(), ElementsAre("CObservationIMU 0"));
}

TEST_F(RawlogMerge, TruncatedInput_IsMergedAsFarAsItGoesAndTold) {
  const std::string path = input("a", "A", {0, 10, 20});
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 5);
  input("b", "B", {5, 50});
  const auto report = mergeRawlogs(options_);
  EXPECT_THAT(output(), ElementsAre("A 0", "B 5", "A 10", "B 50"));
  EXPECT_THAT(report.text(), HasSubstr("rest of an input: the file ends within a record"));
}

TEST_F(RawlogMerge, WrongOptions_AreRefused) {
  EXPECT_THROW(mergeRawlogs(options_), core::ConfigError);
  input("a", "A", {0});
  options_.offset_s[1] = 1;
  EXPECT_THROW(mergeRawlogs(options_), core::ConfigError);
  options_.offset_s.clear();
  options_.inputs.emplace_back("/nowhere/b.rawlog");
  EXPECT_THROW(mergeRawlogs(options_), core::InputError);
}

TEST_F(RawlogMerge, OutputOverAnInput_ReplacesItWhenDone) {
  options_.output = input("a", "A", {0});
  input("b", "B", {1});
  mergeRawlogs(options_);
  EXPECT_THAT(output(), ElementsAre("A 0", "B 1"));
}
