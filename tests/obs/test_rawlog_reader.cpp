#include "s2s/obs/rawlog_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/io/CFileOutputStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose2D.h>
#include <mrpt/serialization/CArchive.h>

#include <cmath>
#include <filesystem>

#include "s2s/core/error.h"
#include "s2s/obs/rawlog_writer.h"
#include "sample_observations.h"
#include "temp_folder.h"

using namespace s2s;
using core::TimeNs;
using obs::RawlogFault;
using test::TempFolder;
using testing::HasSubstr;

namespace {

constexpr TimeNs kMs = 1'000'000;
constexpr int kRecords = 5;

/// Five IMU records, 10 ms apart.
void writeImuLog(const std::string& path, int gzLevel = 0) {
  obs::RawlogWriter writer(path, {gzLevel, 0.0});
  for (int i = 0; i < kRecords; ++i) writer.write(test::sampleImu(test::kSampleTime + 10 * i * kMs));
  writer.close();
}

/// What is left to read after damage, and the faults that were found.
struct ReadBack {
  int count = 0;
  std::vector<RawlogFault> faults;
};

ReadBack readAll(const std::string& path) {
  ReadBack result;
  obs::RawlogReader reader(path);
  while (reader.next()) ++result.count;
  result.faults = reader.faults();
  return result;
}

void writeObjects(const std::string& path, const std::vector<mrpt::serialization::CSerializable::Ptr>& objects) {
  mrpt::io::CFileOutputStream file(path);
  auto archive = mrpt::serialization::archiveFrom(file);
  for (const auto& object : objects) archive << *object;
}

std::string openError(const std::string& path) {
  try {
    const obs::RawlogReader reader(path);
  } catch (const core::InputError& e) {
    return e.fault();
  }
  return "";
}

}  // namespace

TEST(RawlogReader, GoodFile_IsReadToItsEndWithoutFault) {
  TempFolder folder;
  writeImuLog(folder.file("a.rawlog"));
  const auto result = readAll(folder.file("a.rawlog"));
  EXPECT_EQ(result.count, kRecords);
  EXPECT_TRUE(result.faults.empty());
}

TEST(RawlogReader, OwnClasses_SurviveARoundTripThroughGz) {
  TempFolder folder;
  {
    obs::RawlogWriter writer(folder.file("a.rawlog"), {6, 1.0});
    writer.write(test::samplePing());
    writer.write(test::sampleSweep());
    writer.close();
  }
  obs::RawlogReader reader(folder.file("a.rawlog"));
  const auto ping = std::dynamic_pointer_cast<obs::CObservationImagingSonar>(reader.next());
  const auto sweep = std::dynamic_pointer_cast<obs::CObservationLidarSweep>(reader.next());
  ASSERT_TRUE(ping && sweep);
  EXPECT_EQ(ping->samples, test::samplePing()->samples);
  EXPECT_EQ(ping->rowGains, test::samplePing()->rowGains);
  EXPECT_EQ(sweep->echoes[0].range, test::sampleSweep()->echoes[0].range);
  EXPECT_EQ(sweep->nearInfrared, test::sampleSweep()->nearInfrared);
}

TEST(RawlogReader, Position_TellsRecordAndByte) {
  TempFolder folder;
  const std::string path = folder.file("a.rawlog");
  writeImuLog(path);
  const auto recordBytes = std::filesystem::file_size(path) / kRecords;
  obs::RawlogReader reader(path);
  for (unsigned i = 0; i < kRecords; ++i) {
    ASSERT_NE(reader.next(), nullptr);
    EXPECT_EQ(reader.where(), path + ", record " + std::to_string(i) + ", byte " + std::to_string(i * recordBytes));
  }
  EXPECT_EQ(reader.next(), nullptr);
  EXPECT_DOUBLE_EQ(reader.shareRead(), 1.0);
}

TEST(RawlogReader, TruncatedEnd_DeliversWhatIsWholeAndSaysWhere) {
  TempFolder folder;
  const std::string path = folder.file("a.rawlog");
  writeImuLog(path);
  const auto size = std::filesystem::file_size(path), recordBytes = size / kRecords;
  for (const std::uintmax_t missing : {std::uintmax_t{1}, recordBytes / 2, recordBytes - 1}) {
    std::filesystem::resize_file(path, size - missing);
    const auto result = readAll(path);
    EXPECT_EQ(result.count, kRecords - 1);
    ASSERT_EQ(result.faults.size(), 1u);
    EXPECT_EQ(result.faults[0].kind, RawlogFault::Kind::TruncatedEnd);
    EXPECT_EQ(result.faults[0].record, 4u);
    EXPECT_EQ(result.faults[0].byte, 4 * recordBytes);
    EXPECT_TRUE(result.faults[0].fatal());
    std::filesystem::remove(path);
    writeImuLog(path);
  }
}

TEST(RawlogReader, CutBetweenRecords_IsNoFault) {
  TempFolder folder;
  const std::string path = folder.file("a.rawlog");
  writeImuLog(path);
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / kRecords * 3);
  const auto result = readAll(path);
  EXPECT_EQ(result.count, 3);
  EXPECT_TRUE(result.faults.empty());
}

TEST(RawlogReader, TruncatedGz_DeliversWhatIsThereAndSaysSo) {
  TempFolder folder;
  const std::string path = folder.file("a.rawlog");
  {
    obs::RawlogWriter writer(path, {1, 0.0});
    for (int i = 0; i < 2000; ++i) {
      auto imu = test::sampleImu(test::kSampleTime + i * kMs);
      imu->set(mrpt::obs::IMU_WX, std::sin(0.1 * i));  // so that it does not all fit into one block
      writer.write(imu);
    }
    writer.close();
  }
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  const auto result = readAll(path);
  EXPECT_GT(result.count, 100);
  EXPECT_LT(result.count, 2000);
  ASSERT_EQ(result.faults.size(), 1u);
  EXPECT_EQ(result.faults[0].kind, RawlogFault::Kind::TruncatedEnd);
  EXPECT_THAT(result.faults[0].text, HasSubstr("compressed data"));
}

TEST(RawlogReader, UnknownClass_IsNamedWithItsPlace) {
  TempFolder folder;
  const std::string path = folder.file("a.rawlog");
  writeImuLog(path);
  std::string bytes = test::readBytes(path);
  const std::size_t recordBytes = bytes.size() / kRecords;
  const std::size_t name = bytes.find("CObservationIMU", 2 * recordBytes);
  bytes.replace(name, 15, "CObservationXYZ");
  test::writeBytes(path, bytes);
  const auto result = readAll(path);
  EXPECT_EQ(result.count, 2);
  ASSERT_EQ(result.faults.size(), 1u);
  EXPECT_EQ(result.faults[0].kind, RawlogFault::Kind::UnknownClass);
  EXPECT_EQ(result.faults[0].record, 2u);
  EXPECT_EQ(result.faults[0].byte, 2 * recordBytes);
  EXPECT_THAT(result.faults[0].text, HasSubstr("CObservationXYZ"));
}

TEST(RawlogReader, DamagedPayload_IsFoundWithItsPlace) {
  TempFolder folder;
  const std::string path = folder.file("a.rawlog");
  {
    obs::RawlogWriter writer(path, {0, 0.0});
    for (int i = 0; i < 3; ++i) {
      auto ping = test::samplePing();
      ping->timestamp = core::toMrptTime(test::kSampleTime + i * kMs);
      writer.write(ping);
    }
    writer.close();
  }
  std::string bytes = test::readBytes(path);
  const std::size_t recordBytes = bytes.size() / 3;
  // The beam count, 3 (u32), stands before the range count, 4: a place that only the class itself can find wrong.
  const std::size_t beamCount = bytes.find(std::string("\3\0\0\0\4\0\0\0", 8), recordBytes);
  ASSERT_NE(beamCount, std::string::npos);
  bytes[beamCount] = 7;
  test::writeBytes(path, bytes);
  const auto result = readAll(path);
  EXPECT_EQ(result.count, 1);
  ASSERT_EQ(result.faults.size(), 1u);
  EXPECT_EQ(result.faults[0].kind, RawlogFault::Kind::DamagedRecord);
  EXPECT_EQ(result.faults[0].record, 1u);
  EXPECT_EQ(result.faults[0].byte, recordBytes);
  EXPECT_THAT(result.faults[0].text, HasSubstr("24 bytes of samples for 4 ranges x 7 beams"));
}

TEST(RawlogReader, HugeElementCount_IsDamageAndNotAllocated) {
  TempFolder folder;
  const std::string path = folder.file("a.rawlog");
  writeObjects(path, {test::sampleImu(test::kSampleTime), test::samplePing()});
  std::string bytes = test::readBytes(path);
  const std::size_t count = bytes.find(std::string("\x18\0\0\0\1", 5));  // 24 samples of 1 byte
  ASSERT_NE(count, std::string::npos);
  bytes.replace(count, 4, "\xff\xff\xff\xff");
  test::writeBytes(path, bytes);
  const auto result = readAll(path);
  EXPECT_EQ(result.count, 1);
  ASSERT_EQ(result.faults.size(), 1u);
  EXPECT_THAT(result.faults[0].text, HasSubstr("samples claims 4294967295 elements"));
}

TEST(RawlogReader, NewerVersion_IsADamagedRecordNamingTheVersion) {
  TempFolder folder;
  const std::string path = folder.file("a.rawlog");
  writeObjects(path, {test::sampleImu(test::kSampleTime), test::samplePing()});
  std::string bytes = test::readBytes(path);
  const std::string name = "s2s::obs::CObservationImagingSonar";
  bytes[bytes.find(name) + name.size()] = 99;
  test::writeBytes(path, bytes);
  const auto result = readAll(path);
  ASSERT_EQ(result.faults.size(), 1u);
  EXPECT_EQ(result.faults[0].kind, RawlogFault::Kind::DamagedRecord);
  EXPECT_THAT(result.faults[0].text, HasSubstr("99"));
}

TEST(RawlogReader, SensoryFramesAndActions_AreUnpackedInOrder) {
  TempFolder folder;
  const auto frame = mrpt::obs::CSensoryFrame::Create();
  for (int i = 0; i < 3; ++i) frame->insert(test::sampleImu(test::kSampleTime + i * kMs));
  const auto action = mrpt::obs::CActionCollection::Create();
  writeObjects(folder.file("a.rawlog"), {action, frame, action, frame});
  obs::RawlogReader reader(folder.file("a.rawlog"));
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i < 3; ++i) {
      const auto observation = reader.next();
      ASSERT_NE(observation, nullptr);
      EXPECT_EQ(core::fromMrptTime(observation->timestamp), test::kSampleTime + i * kMs);
      EXPECT_THAT(reader.where(), HasSubstr(", record " + std::to_string(1 + 2 * k) + ","));
    }
  EXPECT_EQ(reader.next(), nullptr);
  EXPECT_TRUE(reader.faults().empty());
}

TEST(RawlogReader, EmptyFrame_IsPassedOver) {
  TempFolder folder;
  writeObjects(folder.file("a.rawlog"), {mrpt::obs::CSensoryFrame::Create(), test::sampleImu(test::kSampleTime)});
  EXPECT_EQ(readAll(folder.file("a.rawlog")).count, 1);
}

TEST(RawlogReader, RecordOfAnotherKind_IsSkippedAndNamed) {
  TempFolder folder;
  const auto pose = std::make_shared<mrpt::poses::CPose3D>();
  writeObjects(folder.file("a.rawlog"), {test::sampleImu(test::kSampleTime), pose, test::sampleImu(test::kSampleTime)});
  const auto result = readAll(folder.file("a.rawlog"));
  EXPECT_EQ(result.count, 2);
  ASSERT_EQ(result.faults.size(), 1u);
  EXPECT_EQ(result.faults[0].kind, RawlogFault::Kind::NotAnObservation);
  EXPECT_EQ(result.faults[0].record, 1u);
  EXPECT_THAT(result.faults[0].text, HasSubstr("CPose3D"));
  EXPECT_FALSE(result.faults[0].fatal());
}

TEST(RawlogReader, ConcatenatedFiles_AreReadThrough) {
  TempFolder folder;
  writeImuLog(folder.file("a"), 1);
  writeImuLog(folder.file("b"), 1);
  test::writeBytes(folder.file("c"), test::readBytes(folder.file("a")) + test::readBytes(folder.file("b")));
  EXPECT_EQ(readAll(folder.file("c")).count, 2 * kRecords);
}

TEST(RawlogReader, MissingFile_Throws) { EXPECT_THAT(openError("/nowhere/a.rawlog"), HasSubstr("does not exist")); }

TEST(RawlogReader, Folder_Throws) {
  TempFolder folder;
  EXPECT_THAT(openError(folder.path()), HasSubstr("not a file"));
}

TEST(RawlogReader, EmptyFile_ThrowsSayingSo) {
  TempFolder folder;
  test::writeBytes(folder.file("a.rawlog"), "");
  EXPECT_THAT(openError(folder.file("a.rawlog")), HasSubstr("0 bytes"));
}

TEST(RawlogReader, SomethingElse_Throws) {
  TempFolder folder;
  test::writeBytes(folder.file("a.rawlog"), "This is a letter, not a rawlog. " + std::string(1000, 'x'));
  EXPECT_THAT(openError(folder.file("a.rawlog")), HasSubstr("not a readable rawlog"));
  test::writeBytes(folder.file("b.rawlog"), std::string("\x28\xb5\x2f\xfd", 4) + std::string(1000, 'x'));  // zstd
  EXPECT_THAT(openError(folder.file("b.rawlog")), HasSubstr("not a readable rawlog"));
}

TEST(RawlogSummary, TwoSensors_AreCountedWithTheirSpans) {
  TempFolder folder;
  const std::string path = folder.file("a.rawlog");
  {
    obs::RawlogWriter writer(path, {0, 1.0});
    for (int i = 0; i < 4; ++i) writer.write(test::sampleImu(test::kSampleTime + (5 + 10 * i) * kMs));
    writer.write(test::samplePing());
    writer.close();
  }
  const auto summary = obs::summarizeRawlog(path);
  EXPECT_EQ(summary.records, 5u);
  EXPECT_EQ(summary.backwards, 0u);
  EXPECT_EQ(summary.first, test::kSampleTime);
  EXPECT_EQ(summary.last, test::kSampleTime + 35 * kMs);
  ASSERT_EQ(summary.sensors.size(), 2u);
  EXPECT_EQ(summary.sensors.at("IMU").count, 4u);
  EXPECT_EQ(summary.sensors.at("IMU").first, test::kSampleTime + 5 * kMs);
  EXPECT_EQ(summary.sensors.at("SONAR_HORIZONTAL").className, "s2s::obs::CObservationImagingSonar");
}

TEST(RawlogSummary, TimeRunningBackwards_IsCounted) {
  TempFolder folder;
  const auto at = [](TimeNs ms) { return test::sampleImu(test::kSampleTime + ms * kMs); };
  writeObjects(folder.file("a.rawlog"), {at(0), at(20), at(10), at(30)});
  EXPECT_EQ(obs::summarizeRawlog(folder.file("a.rawlog")).backwards, 1u);
}
