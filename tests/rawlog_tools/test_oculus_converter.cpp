#include "oculus2rawlog/oculus_converter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "oculus_bytes.h"
#include "s2s/core/error.h"
#include "s2s/obs/rawlog_reader.h"
#include "temp_folder.h"

using namespace s2s;
using namespace s2s::tools;
using testing::HasSubstr;

namespace {

std::vector<obs::CObservationImagingSonar::Ptr> pingsIn(const std::string& path) {
  std::vector<obs::CObservationImagingSonar::Ptr> pings;
  obs::RawlogReader reader(path);
  while (const auto observation = reader.next())
    pings.push_back(std::dynamic_pointer_cast<obs::CObservationImagingSonar>(observation));
  return pings;
}

class OculusConverter : public testing::Test {
 protected:
  OculusConverter() {
    oculus_.input = folder_.file("a.raw");
    options_.output = folder_.file("a.rawlog");
    options_.label = "SONAR_HORIZONTAL";
  }
  ConversionReport convert(const std::string& bytes) {
    test::writeBytes(oculus_.input, bytes);
    return convertOculusStream(oculus_, options_);
  }
  test::TempFolder folder_;
  oculus::OculusOptions oculus_;
  ConverterOptions options_;
};

std::string ping(std::uint32_t id, double time_s, int layout = 2) {
  test::OculusPing p;
  p.pingId = id;
  p.layout = layout;
  p.startTime = layout == 2 ? time_s : 1e9 * time_s;
  return test::oculusMessage(p);
}

}  // namespace

TEST_F(OculusConverter, Times_AreTheDevicesFromTheStartTimeOn) {
  options_.startTime = 1'700'000'000'000'000'000;
  options_.T_vehicle_sensor = core::isometryFromXyzYpr(-2, 0, -0.5, 0, M_PI / 4, 0);
  oculus_.verticalAperture_rad = 0.2;
  oculus_.bearingModel = obs::BearingModel::Cone;
  convert(ping(1, 100.5) + ping(2, 100.75));
  const auto pings = pingsIn(options_.output);
  ASSERT_EQ(pings.size(), 2u);
  EXPECT_EQ(core::fromMrptTime(pings[0]->timestamp), 1'700'000'000'000'000'000);
  EXPECT_EQ(core::fromMrptTime(pings[1]->timestamp), 1'700'000'000'250'000'000);
  EXPECT_DOUBLE_EQ(pings[1]->deviceTime_s, 100.75);
  EXPECT_EQ(pings[0]->sensorLabel, "SONAR_HORIZONTAL");
  EXPECT_EQ(pings[0]->verticalAperture_rad, 0.2);
  EXPECT_EQ(pings[0]->bearingModel, obs::BearingModel::Cone);
  EXPECT_TRUE(core::toIsometry(pings[0]->sensorPose).isApprox(options_.T_vehicle_sensor, 1e-12));
}

TEST_F(OculusConverter, LostPings_AreToldByTheirNumbers) {
  EXPECT_THAT(convert(ping(1, 1) + ping(2, 1.1) + ping(5, 1.4)).text(), HasSubstr("2 pings are missing"));
}

TEST_F(OculusConverter, OtherMessagesAndDamage_AreCountedWithReasonAndPlace) {
  std::string bad = ping(2, 2);
  test::put<double>(bad, 162, -1.0);  // range resolution
  const auto report = convert(ping(1, 1) + bad + test::oculusHeader(0xff, 0, 0) + "noise" + ping(3, 3));
  EXPECT_EQ(report.readCount(oculus::kPings), 2u);
  EXPECT_EQ(report.skippedCount("pings with an impossible range resolution"), 1u);
  EXPECT_EQ(report.skippedCount("bytes that belong to no whole message"), 5u);
  EXPECT_THAT(report.text(), HasSubstr("messages of type 0xff"));
  EXPECT_THAT(report.text(), HasSubstr("byte " + std::to_string(ping(1, 1).size())));
}

TEST_F(OculusConverter, NoPing_IsRefusedAndLeavesNoFile) {
  EXPECT_THROW(convert("this is a letter"), core::InputError);
  EXPECT_THROW(convert(""), core::InputError);
  EXPECT_FALSE(std::filesystem::exists(options_.output));
  oculus_.input = "/nowhere/a.raw";
  EXPECT_THROW(convertOculusStream(oculus_, options_), core::InputError);
}

TEST_F(OculusConverter, RealPings_AreAsRecorded) {
  oculus_.input = std::string(S2S_DATA_DIR) + "/oculus/three_pings_8bit.raw";
  if (!std::filesystem::exists(oculus_.input)) GTEST_SKIP() << oculus_.input << " is not there";
  const auto report = convertOculusStream(oculus_, options_);
  EXPECT_TRUE(report.skipped().empty());
  const auto pings = pingsIn(options_.output);
  ASSERT_EQ(pings.size(), 3u);
  const std::string bytes = test::readBytes(oculus_.input);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& ping = *pings[i];
    EXPECT_EQ(ping.rangeCount, 703u);
    EXPECT_EQ(ping.beamCount, 256u);
    EXPECT_EQ(ping.bytesPerSample, 1);
    EXPECT_TRUE(ping.rowGains.empty());
    EXPECT_EQ(ping.pingId, 415'323 + i);
    EXPECT_NEAR(ping.soundSpeed_mps, 1490.66, 0.01);
    EXPECT_EQ(ping.gain_percent, 50);
    // 703 bins over the 2 m that the sonar was set to, to one bin.
    EXPECT_NEAR(ping.maxRange_m(), 2.0, 0.003);
    // 60 degrees wide, from port to starboard, symmetric.
    EXPECT_NEAR(ping.bearings_rad.front(), 30 * M_PI / 180, 1e-6);
    EXPECT_NEAR(ping.bearings_rad.back(), -30 * M_PI / 180, 1e-6);
    // The image is the last part of each message, byte for byte.
    const std::string image = bytes.substr((i + 1) * bytes.size() / 3 - 703 * 256, 703 * 256);
    EXPECT_TRUE(std::equal(image.begin(), image.end(), reinterpret_cast<const char*>(ping.samples.data())));
  }
  // The three pings are 62.5 ms apart.
  EXPECT_NEAR(pings[2]->deviceTime_s - pings[0]->deviceTime_s, 0.125, 1e-3);
}
