#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/obs/CObservationIMU.h>

#include <cmath>

#include "s2s/core/error.h"
#include "s2s/obs/rawlog_writer.h"
#include "survey_reading.h"
#include "temp_folder.h"

namespace s2s::mapper {
namespace {

using ::testing::ElementsAre;

constexpr core::TimeNs kStart = 1'733'400'000'000'000'000;

/// Writes records of these times (seconds after the start) as they come, and reads a part of them.
std::vector<double> timesRead(const std::vector<double>& written_s, double from_s, double to_s) {
  const test::TempFolder folder;
  obs::RawlogWriterOptions options;
  options.sorted = false;
  obs::RawlogWriter writer(folder.file("a.rawlog"), options);
  for (const double t_s : written_s) {
    auto record = mrpt::obs::CObservationIMU::Create();
    record->sensorLabel = "IMU";
    record->timestamp = core::toMrptTime(kStart + core::durationNs(t_s));
    writer.write(record);
  }
  writer.close();
  obs::RawlogReader reader(folder.file("a.rawlog"));
  FaultLog faults;
  std::vector<double> read_s;
  readRecords({from_s, to_s, "", nullptr}, reader, faults,
              [&read_s](const mrpt::obs::CObservation::Ptr& record, const std::string&) {
                read_s.push_back(1e-9 * static_cast<double>(core::fromMrptTime(record->timestamp) - kStart));
              });
  return read_s;
}

TEST(SurveyReading, PartOfARawlog_IsByTimeFromTheFirstRecord) {
  EXPECT_THAT(timesRead({0, 1, 2, 3, 4}, 1, 3), ElementsAre(1, 2, 3));
  EXPECT_THAT(timesRead({0, 1, 2}, 0, -1), ElementsAre(0, 1, 2));
}

TEST(SurveyReading, PartThatEndsBeforeItBegins_IsAConfigError) {
  EXPECT_THROW(timesRead({0, 1, 2}, 2, 1), core::ConfigError);
}

TEST(SurveyReading, PartBehindTheEnd_IsAnInputErrorThatSaysSo) {
  try {
    timesRead({0, 1, 2}, 100, -1);
    FAIL() << "no error";
  } catch (const core::InputError& e) {
    EXPECT_THAT(e.fault(), ::testing::HasSubstr("no record in that part"));
  }
}

TEST(SurveyReading, OneWrongTimeOrSensorThatIsEarly_DoesNotEndThePart) {
  EXPECT_THAT(timesRead({0, 1, 4e8, 2, 5, 3}, 0, 3), ElementsAre(0, 1, 2, 3));
}

TEST(SurveyReading, FirstRecordBefore1970_IsHandedOnAndDoesNotShiftThePart) {
  const double none_s = -2e9;
  const auto read_s = timesRead({none_s, 10, 11, 12}, 1, 1.5);
  ASSERT_EQ(read_s.size(), 2U);
  EXPECT_LT(read_s[0], -1e9);
  EXPECT_DOUBLE_EQ(read_s[1], 11);
}

}  // namespace
}  // namespace s2s::mapper
