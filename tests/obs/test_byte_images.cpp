// Rawlogs that older versions wrote must stay readable, with every field.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "s2s/obs/rawlog_reader.h"
#include "sample_observations.h"

using namespace s2s;
using testing::ElementsAre;

namespace {

template <class Observation>
std::shared_ptr<Observation> readImage(const std::string& name) {
  obs::RawlogReader reader(std::string(S2S_SOURCE_DIR) + "/tests/data/" + name);
  auto observation = std::dynamic_pointer_cast<Observation>(reader.next());
  EXPECT_EQ(reader.next(), nullptr);
  EXPECT_TRUE(reader.faults().empty());
  return observation;
}

}  // namespace

TEST(ByteImage, ImagingSonarVersion0_KeepsAllFields) {
  const auto ping = readImage<obs::CObservationImagingSonar>("obs_version_0/imaging_sonar.rawlog");
  ASSERT_NE(ping, nullptr);
  EXPECT_EQ(core::fromMrptTime(ping->timestamp), test::kSampleTime);
  EXPECT_EQ(ping->sensorLabel, "SONAR_HORIZONTAL");
  EXPECT_EQ(ping->sensorModel, "Sample 1");
  EXPECT_EQ(ping->sensorPose, mrpt::poses::CPose3D(1.5, -0.25, -0.75, 0.1, 0.2, -0.3));
  EXPECT_EQ(ping->beamCount, 3u);
  EXPECT_EQ(ping->rangeCount, 4u);
  EXPECT_EQ(ping->bytesPerSample, 2);
  ASSERT_EQ(ping->samples.size(), 24u);
  for (unsigned i = 0; i < 12; ++i) EXPECT_EQ(ping->sample(i / 3, i % 3), 17 * i + 256 * i);
  EXPECT_THAT(ping->rowGains, ElementsAre(70'000, 1, 2, 3));
  EXPECT_THAT(ping->bearings_rad, ElementsAre(-0.5f, 0.125f, 0.75f));
  EXPECT_EQ(ping->rangeOffset_m, 0.25);
  EXPECT_EQ(ping->rangeResolution_m, 0.5);
  EXPECT_EQ(ping->verticalAperture_rad, 0.35);
  EXPECT_EQ(ping->bearingModel, obs::BearingModel::Cone);
  EXPECT_EQ(ping->soundSpeed_mps, 1481.5);
  EXPECT_EQ(ping->frequency_hz, 750e3);
  EXPECT_EQ(ping->gain_percent, 42);
  EXPECT_EQ(ping->pingId, 4711u);
  EXPECT_EQ(ping->deviceTime_s, 12.25);
}

TEST(ByteImage, LidarSweepVersion0_KeepsAllFields) {
  const auto sweep = readImage<obs::CObservationLidarSweep>("obs_version_0/lidar_sweep.rawlog");
  ASSERT_NE(sweep, nullptr);
  EXPECT_EQ(core::fromMrptTime(sweep->timestamp), test::kSampleTime);
  EXPECT_EQ(sweep->sensorLabel, "LIDAR");
  EXPECT_EQ(sweep->sensorModel, "Sample 2");
  EXPECT_EQ(sweep->sensorPose, mrpt::poses::CPose3D(0.5, 0.25, 2, -0.1, 0.05, 0.2));
  EXPECT_EQ(sweep->rowCount, 2u);
  EXPECT_EQ(sweep->columnCount, 3u);
  EXPECT_EQ(sweep->rangeResolution_m, 0.002);
  EXPECT_EQ(sweep->minRange_m, 0.3);
  EXPECT_EQ(sweep->maxRange_m, 120);
  ASSERT_EQ(sweep->echoes.size(), 2u);
  EXPECT_THAT(sweep->echoes[0].range, ElementsAre(1000, 0, 300'000, 5, 6, 7));
  EXPECT_THAT(sweep->echoes[0].reflectivity, ElementsAre(1, 2, 3, 300, 5, 6));
  EXPECT_THAT(sweep->echoes[0].signal, ElementsAre(10, 20, 30, 40, 50, 60'000));
  EXPECT_THAT(sweep->echoes[0].flags, ElementsAre(0, 1, 2, 3, 4, 31));
  EXPECT_THAT(sweep->echoes[1].range, ElementsAre(0, 0, 310'000, 0, 0, 0));
  EXPECT_TRUE(sweep->echoes[1].signal.empty());
  EXPECT_THAT(sweep->nearInfrared, ElementsAre(100, 200, 300, 400, 500, 65'535));
  EXPECT_THAT(sweep->beamAltitude_rad, ElementsAre(0.25f, -0.25f));
  EXPECT_THAT(sweep->beamAzimuth_rad, ElementsAre(0.0625f, -0.0625f));
  EXPECT_EQ(sweep->beamOriginOffset_m, 0.0158);
  EXPECT_EQ(sweep->beamOriginHeight_m, 0.003);
  EXPECT_EQ(sweep->T_sensor_lidar, mrpt::poses::CPose3D(0, 0, 0.036, M_PI, 0, 0));
  EXPECT_THAT(sweep->columnAzimuth_rad, ElementsAre(0.0f, -2.0f, -4.0f));
  EXPECT_THAT(sweep->columnTime_ns, ElementsAre(0, 30'000'000, 60'000'000));
  EXPECT_THAT(sweep->rowTime_ns, ElementsAre(0, 250));
  EXPECT_THAT(sweep->columnValid, ElementsAre(1, 0, 1));
  EXPECT_EQ(sweep->deviceTime_s, 77.5);
  EXPECT_EQ(sweep->frameId, 638u);
}
