#include "ouster2rawlog/ouster_converter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/obs/CObservationIMU.h>

#include <cmath>
#include <filesystem>

#include "network_bytes.h"
#include "ouster_bytes.h"
#include "s2s/core/error.h"
#include "s2s/obs/CObservationLidarSweep.h"
#include "s2s/obs/rawlog_reader.h"
#include "temp_folder.h"

using namespace s2s;
using namespace s2s::tools;
using testing::HasSubstr;

namespace {

/// A capture of two frames and an IMU packet of the test sensor, and its metadata, in a folder of its own.
class OusterConverter : public testing::Test {
 protected:
  OusterConverter() {
    maker_.metadata = test::ousterMetadata("RNG19_RFL8_SIG16_NIR16");
    maker_.pixel = [](std::uint32_t row, std::uint32_t column) {
      test::OusterPixel pixel;
      pixel.range = 1000 + 100 * row + column;
      return pixel;
    };
    maker_.time = [this](std::uint32_t column) { return deviceStart_ + 3'000'000u * column; };
    ouster_.capture = folder_.file("a.pcap");
    ouster_.metadata = folder_.file("a.json");
    options_.output = folder_.file("a.rawlog");
    options_.label = "LIDAR";
    test::writeBytes(ouster_.metadata, test::ousterMetadataJson("RNG19_RFL8_SIG16_NIR16"));
  }

  std::string frame(const std::string& payload, std::uint16_t port, std::uint8_t host = 5) const {
    return test::ethernet(test::ipv4(test::udp(payload, port), 1, 0, false, 17, host));
  }

  void addLidarFrame(std::uint32_t frameId) {
    for (std::uint32_t p = 0; p < 4; ++p) frames_.push_back(frame(maker_.packet(frameId, 8 * p), 7502));
    deviceStart_ += 100'000'000;
  }

  void addImu() {
    test::ByteWriter packet;
    packet.add(deviceStart_).add(deviceStart_).add(deviceStart_);
    for (const float value : {0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 90.0f}) packet.add(value);
    frames_.push_back(frame(packet.bytes(), 7503));
  }

  ConversionReport convert(std::uint32_t captureSecond = 1'700'000'000) {
    test::writeBytes(ouster_.capture, test::pcap(frames_, 1, captureSecond));
    return ouster::convertOusterCapture(ouster_, options_);
  }

  template <class Observation>
  std::vector<std::shared_ptr<Observation>> read() const {
    std::vector<std::shared_ptr<Observation>> result;
    obs::RawlogReader reader(options_.output);
    while (const auto observation = reader.next())
      if (auto wanted = std::dynamic_pointer_cast<Observation>(observation)) result.push_back(wanted);
    EXPECT_TRUE(reader.faults().empty());
    return result;
  }

  test::TempFolder folder_;
  std::uint64_t deviceStart_ = 50'000'000'000;
  test::OusterPacketMaker maker_;
  std::vector<std::string> frames_;
  ouster::OusterOptions ouster_;
  ConverterOptions options_;
};

}  // namespace

TEST_F(OusterConverter, SmallCapture_GivesSweepsAndImuWithPoses) {
  options_.T_vehicle_sensor = core::isometryFromXyzYpr(1, 2, 3, 0.5, 0, 0);
  addLidarFrame(1);
  addImu();
  addLidarFrame(2);
  const auto report = convert();
  EXPECT_EQ(report.readCount(ouster::kSweeps), 2u);
  EXPECT_EQ(report.readCount(ouster::kImuReadings), 1u);
  EXPECT_TRUE(report.skipped().empty());
  const auto sweeps = read<obs::CObservationLidarSweep>();
  ASSERT_EQ(sweeps.size(), 2u);
  EXPECT_EQ(sweeps[0]->sensorLabel, "LIDAR");
  EXPECT_TRUE(core::toIsometry(sweeps[0]->sensorPose).isApprox(options_.T_vehicle_sensor, 1e-12));
  const auto imus = read<mrpt::obs::CObservationIMU>();
  ASSERT_EQ(imus.size(), 1u);
  EXPECT_EQ(imus[0]->sensorLabel, "IMU");
  EXPECT_DOUBLE_EQ(imus[0]->get(mrpt::obs::IMU_Z_ACC), 9.80665);
  EXPECT_DOUBLE_EQ(imus[0]->get(mrpt::obs::IMU_WZ), M_PI / 2);
  EXPECT_TRUE(
      core::toIsometry(imus[0]->sensorPose).isApprox(options_.T_vehicle_sensor * maker_.metadata.T_sensor_imu, 1e-12));
}

TEST_F(OusterConverter, ClockFromPowerOn_IsTiedToTheCaptureByTheFastestPacket) {
  addLidarFrame(1);
  convert();
  const auto sweep = read<obs::CObservationLidarSweep>().at(0);
  // Packet p is captured p ms after the start and ends with the device time of column 8 p + 7, 3 ms a column; the last
  // packet has the smallest difference: 3 ms - 31 * 3 ms = -90 ms of the capture's start and the first column.
  EXPECT_EQ(core::fromMrptTime(sweep->timestamp), 1'700'000'000'000'000'000 - 90'000'000);
  EXPECT_NEAR(sweep->deviceTime_s, 50, 1e-9);
}

TEST_F(OusterConverter, DeviceOnUtc_IsBelieved) {
  deviceStart_ = 1'650'000'000'500'000'000;
  addLidarFrame(1);
  convert();
  const auto sweep = read<obs::CObservationLidarSweep>().at(0);
  EXPECT_EQ(core::fromMrptTime(sweep->timestamp), 1'650'000'000'500'000'000);
  EXPECT_LT(sweep->deviceTime_s, 0);
}

TEST_F(OusterConverter, StartTime_BeatsBothClocks) {
  options_.startTime = 1'600'000'000'000'000'000;
  addLidarFrame(1);
  addLidarFrame(2);
  convert();
  const auto sweeps = read<obs::CObservationLidarSweep>();
  EXPECT_EQ(core::fromMrptTime(sweeps.at(0)->timestamp), 1'600'000'000'000'000'000);
  EXPECT_EQ(core::fromMrptTime(sweeps.at(1)->timestamp), 1'600'000'000'100'000'000);
}

TEST_F(OusterConverter, NoWallClockAnywhere_BeginsAtTheDefault) {
  addLidarFrame(1);
  convert(0);
  EXPECT_EQ(core::fromMrptTime(read<obs::CObservationLidarSweep>().at(0)->timestamp), kDefaultStartTime);
}

TEST_F(OusterConverter, ClockThatRunsBackwards_LosesRecordsButNotTheConversion) {
  for (std::uint32_t frameId = 0; frameId < 40; ++frameId) addLidarFrame(frameId);  // 4 s
  deviceStart_ = 1'000'000'000;  // the sensor was switched off and on
  addLidarFrame(50);
  addImu();
  const auto report = convert();
  EXPECT_EQ(report.readCount(ouster::kSweeps), 40u);
  EXPECT_EQ(report.skippedCount("LiDAR sweeps because the sensor's clock ran backwards"), 1u);
  EXPECT_EQ(report.skippedCount("IMU readings because the sensor's clock ran backwards"), 1u);
  EXPECT_EQ(read<obs::CObservationLidarSweep>().size(), 40u);
}

TEST_F(OusterConverter, ClockThatIsSetWhileRecording_IsNoted) {
  addLidarFrame(1);
  deviceStart_ += 1'000'000'000'000;
  addLidarFrame(2);
  EXPECT_THAT(convert().text(), HasSubstr("the sensor's clock jumps by 1000.1"));
}

TEST_F(OusterConverter, FragmentedPackets_AreReadLikeWholeOnes) {
  std::uint16_t id = 1;
  for (std::uint32_t p = 0; p < 4; ++p)
    for (const auto& packet : test::fragments(test::udp(maker_.packet(1, 8 * p)), 256, id++))
      frames_.push_back(test::ethernet(packet));
  EXPECT_EQ(convert().readCount(ouster::kSweeps), 1u);
  EXPECT_EQ(read<obs::CObservationLidarSweep>().at(0)->returnCount(), 4u * 32u);
}

TEST_F(OusterConverter, SecondSensorInTheCapture_IsLeftOutAndCounted) {
  addLidarFrame(1);
  for (std::uint32_t p = 0; p < 4; ++p) frames_.push_back(frame(maker_.packet(9, 8 * p), 7502, 6));
  const auto report = convert();
  EXPECT_EQ(report.readCount(ouster::kSweeps), 1u);
  EXPECT_EQ(report.skippedCount("packets of another sender"), 4u);
  ouster_.source = "10.0.0.6";
  EXPECT_EQ(convert().readCount(ouster::kSweeps), 1u);
  EXPECT_EQ(read<obs::CObservationLidarSweep>().at(0)->frameId, 9u);
}

TEST_F(OusterConverter, StrangePackets_AreCountedWithTheirSize) {
  addLidarFrame(1);
  frames_.push_back(frame(std::string(500, 'x'), 7502));
  EXPECT_THAT(convert().text(), HasSubstr("1 packets of 500 bytes"));
}

TEST_F(OusterConverter, MetadataOfAnotherProfile_IsRefusedSayingWhatIsThere) {
  addLidarFrame(1);
  test::writeBytes(ouster_.metadata, test::ousterMetadataJson("RNG15_RFL8_NIR8"));
  try {
    convert();
    FAIL() << "accepted";
  } catch (const core::InputError& e) {
    EXPECT_THAT(e.fault(), HasSubstr("RNG15_RFL8_NIR8"));
    EXPECT_THAT(e.fault(), HasSubstr("4 of 544 bytes"));
  }
  EXPECT_FALSE(std::filesystem::exists(options_.output));
}

TEST_F(OusterConverter, MetadataOfAnotherSensor_IsNoted) {
  std::string json = test::ousterMetadataJson("RNG19_RFL8_SIG16_NIR16");
  json.replace(json.find("\"122\""), 5, "\"999\"");
  test::writeBytes(ouster_.metadata, json);
  addLidarFrame(1);
  EXPECT_THAT(convert().text(), HasSubstr("packets come from sensor 122, the metadata from 999"));
}

TEST_F(OusterConverter, TruncatedCapture_KeepsWhatIsWholeAndSaysSo) {
  addLidarFrame(1);
  addLidarFrame(2);
  const std::string file = test::pcap(frames_);
  test::writeBytes(ouster_.capture, file.substr(0, file.size() - 100));
  const auto report = ouster::convertOusterCapture(ouster_, options_);
  EXPECT_EQ(report.readCount(ouster::kSweeps), 2u);
  EXPECT_THAT(report.text(), HasSubstr("rest of the capture: truncated"));
  EXPECT_THAT(report.text(), HasSubstr("1 sweeps lack columns that were not received, 8 in all"));
}

TEST(OusterCapture, RealDrive_GivesAllSweepsAndImuReadings) {
  const std::string folder = std::string(S2S_DATA_DIR) + "/ouster/";
  ouster::OusterOptions ouster;
  ouster.capture = folder + "OS-1-128_v2.3.0_1024x10_lb_n3.pcap";
  ouster.metadata = folder + "OS-1-128_v2.3.0_1024x10.json";
  if (!std::filesystem::exists(ouster.capture)) GTEST_SKIP() << ouster.capture << " is not there";
  test::TempFolder out;
  ConverterOptions options;
  options.output = out.file("a.rawlog");
  options.label = "LIDAR";
  const auto report = convertOusterCapture(ouster, options);
  EXPECT_EQ(report.readCount(ouster::kSweeps), 3u);
  EXPECT_EQ(report.readCount(ouster::kLidarPackets), 192u);
  EXPECT_EQ(report.readCount(ouster::kImuReadings), 30u);
  EXPECT_TRUE(report.skipped().empty());

  obs::RawlogReader reader(options.output);
  core::TimeNs last = 0;
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();
  while (const auto observation = reader.next()) {
    const auto time = core::fromMrptTime(observation->timestamp);
    EXPECT_GE(time, last);
    last = time;
    // The capture began at 1650410295.35 by its own clock and lasts 0.3 s.
    EXPECT_NEAR(1e-9 * static_cast<double>(time - 1'650'410'295'350'000'000), 0.15, 0.2);
    if (const auto sweep = std::dynamic_pointer_cast<obs::CObservationLidarSweep>(observation)) {
      EXPECT_TRUE(sweep->columnValid.empty());
      EXPECT_NEAR(sweep->duration_s(), 0.1 * 1023 / 1024, 1e-3);  // 10 Hz, to the steadiness of its motor
      EXPECT_GT(sweep->returnCount(), sweep->pixelCount() / 4);
    } else {
      const auto imu = std::dynamic_pointer_cast<mrpt::obs::CObservationIMU>(observation);
      ASSERT_NE(imu, nullptr);
      acceleration += Eigen::Vector3d(imu->get(mrpt::obs::IMU_X_ACC), imu->get(mrpt::obs::IMU_Y_ACC),
                                      imu->get(mrpt::obs::IMU_Z_ACC)) /
                      30;
    }
  }
  // Gravity's reaction points up; the car accelerates by some m/s^2 besides.
  EXPECT_NEAR(acceleration.z(), 9.8, 1.0);
}
