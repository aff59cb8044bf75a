#include "s2s/obs/rawlog_writer.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "full_disk.h"
#include "s2s/core/error.h"
#include "s2s/obs/rawlog_reader.h"
#include "sample_observations.h"
#include "temp_folder.h"

using namespace s2s;
using core::TimeNs;
using test::TempFolder;

namespace {

constexpr TimeNs kMs = 1'000'000;

std::vector<TimeNs> timesIn(const std::string& path) {
  std::vector<TimeNs> times;
  obs::RawlogReader reader(path);
  while (const auto observation = reader.next())
    times.push_back((core::fromMrptTime(observation->timestamp) - test::kSampleTime) / kMs);
  return times;
}

auto imuAt(TimeNs ms) { return test::sampleImu(test::kSampleTime + ms * kMs); }

}  // namespace

TEST(RawlogWriter, OutOfOrderWithinTheWindow_IsSorted) {
  TempFolder folder;
  obs::RawlogWriter writer(folder.file("a.rawlog"), {0, 0.1});
  for (const TimeNs ms : {0, 50, 20, 90, 60, 300, 210}) writer.write(imuAt(ms));
  EXPECT_EQ(writer.count(), 7u);
  writer.close();
  EXPECT_EQ(timesIn(folder.file("a.rawlog")), (std::vector<TimeNs>{0, 20, 50, 60, 90, 210, 300}));
}

TEST(RawlogWriter, EqualTimes_KeepTheOrderOfArrival) {
  TempFolder folder;
  obs::RawlogWriter writer(folder.file("a.rawlog"));
  for (int i = 0; i < 5; ++i) {
    auto imu = imuAt(0);
    imu->sensorLabel = std::string(1, static_cast<char>('a' + i));
    writer.write(imu);
  }
  writer.close();
  obs::RawlogReader reader(folder.file("a.rawlog"));
  for (int i = 0; i < 5; ++i) EXPECT_EQ(reader.next()->sensorLabel, std::string(1, static_cast<char>('a' + i)));
}

TEST(RawlogWriter, LaterThanTheWindowAllows_ThrowsNamingSensorAndTime) {
  TempFolder folder;
  obs::RawlogWriter writer(folder.file("a.rawlog"), {0, 0.1});
  writer.write(imuAt(0));
  writer.write(imuAt(500));
  writer.write(imuAt(700));
  try {
    writer.write(imuAt(100));
    FAIL() << "accepted";
  } catch (const core::InputError& e) {
    EXPECT_NE(e.where().find("'IMU'"), std::string::npos);
    EXPECT_NE(e.fault().find("400 ms"), std::string::npos);
  }
}

TEST(RawlogWriter, NoLabelOrNoTime_Throws) {
  TempFolder folder;
  obs::RawlogWriter writer(folder.file("a.rawlog"));
  auto unlabelled = imuAt(0);
  unlabelled->sensorLabel.clear();
  EXPECT_THROW(writer.write(unlabelled), core::InputError);
  auto timeless = imuAt(0);
  timeless->timestamp = INVALID_TIMESTAMP;
  EXPECT_THROW(writer.write(timeless), core::InputError);
}

TEST(RawlogWriter, NotClosed_LeavesNothing) {
  TempFolder folder;
  {
    obs::RawlogWriter writer(folder.file("a.rawlog"));
    writer.write(imuAt(0));
  }
  EXPECT_EQ(folder.fileCount(), 0u);
}

TEST(RawlogWriter, BeforeClose_TheOldFileIsIntact) {
  TempFolder folder;
  test::writeBytes(folder.file("a.rawlog"), "old");
  obs::RawlogWriter writer(folder.file("a.rawlog"));
  writer.write(imuAt(0));
  EXPECT_EQ(test::readBytes(folder.file("a.rawlog")), "old");
  writer.close();
  EXPECT_EQ(timesIn(folder.file("a.rawlog")), (std::vector<TimeNs>{0}));
}

TEST(RawlogWriter, Compressed_IsSmallerAndReadsTheSame) {
  TempFolder folder;
  for (const int level : {0, 1, 9}) {
    obs::RawlogWriter writer(folder.file(std::to_string(level)), {level, 1.0});
    for (int i = 0; i < 200; ++i) writer.write(imuAt(10 * i));
    writer.close();
  }
  EXPECT_EQ(timesIn(folder.file("9")), timesIn(folder.file("0")));
  EXPECT_LT(std::filesystem::file_size(folder.file("1")), std::filesystem::file_size(folder.file("0")) / 4);
  EXPECT_EQ(test::readBytes(folder.file("9")).substr(0, 2), "\x1f\x8b");
}

TEST(RawlogWriter, UnwritableFolder_ThrowsOutputError) {
  TempFolder folder;
  test::writeBytes(folder.file("a"), "");
  EXPECT_THROW(obs::RawlogWriter(folder.file("a/b.rawlog")), core::OutputError);
}

TEST(RawlogWriter, FullDisk_ThrowsOutputErrorAndLeavesNothing) {
  TempFolder folder;
  // One record is about 440 bytes, so ten fit into the stream's buffer and the fault only shows when it is closed.
  for (const int count : {10, 2000}) {
    const test::FullDisk disk(1000);
    const auto writeAll = [&] {
      obs::RawlogWriter writer(folder.file("a.rawlog"));
      for (int i = 0; i < count; ++i) writer.write(imuAt(10 * i));
      writer.close();
    };
    EXPECT_THROW(writeAll(), core::OutputError) << count;
  }
  EXPECT_EQ(folder.fileCount(), 0u);
}

TEST(RawlogWriter, NotSorted_KeepsTheOrderOfArrival) {
  TempFolder folder;
  obs::RawlogWriterOptions options;
  options.sorted = false;
  obs::RawlogWriter writer(folder.file("a.rawlog"), options);
  for (const TimeNs ms : {0, 5000, 20}) writer.write(imuAt(ms));
  writer.close();
  EXPECT_EQ(timesIn(folder.file("a.rawlog")), (std::vector<TimeNs>{0, 5000, 20}));
}
