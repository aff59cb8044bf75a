#include "sample_observations.h"

#include <cmath>
#include <cstdint>

namespace s2s::test {

obs::CObservationImagingSonar::Ptr samplePing() {
  auto ping = obs::CObservationImagingSonar::Create();
  ping->timestamp = core::toMrptTime(kSampleTime);
  ping->sensorLabel = "SONAR_HORIZONTAL";
  ping->sensorModel = "Sample 1";
  ping->sensorPose = mrpt::poses::CPose3D(1.5, -0.25, -0.75, 0.1, 0.2, -0.3);
  ping->beamCount = 3;
  ping->rangeCount = 4;
  ping->bytesPerSample = 2;
  for (unsigned i = 0; i < 3 * 4; ++i) {
    ping->samples.push_back(static_cast<std::uint8_t>(17 * i));
    ping->samples.push_back(static_cast<std::uint8_t>(i));
  }
  ping->rowGains = {70'000, 1, 2, 3};
  ping->bearings_rad = {-0.5f, 0.125f, 0.75f};
  ping->rangeOffset_m = 0.25;
  ping->rangeResolution_m = 0.5;
  ping->verticalAperture_rad = 0.35;
  ping->bearingModel = obs::BearingModel::Cone;
  ping->soundSpeed_mps = 1481.5;
  ping->frequency_hz = 750e3;
  ping->gain_percent = 42;
  ping->pingId = 4711;
  ping->deviceTime_s = 12.25;
  return ping;
}

obs::CObservationLidarSweep::Ptr sampleSweep() {
  auto sweep = obs::CObservationLidarSweep::Create();
  sweep->timestamp = core::toMrptTime(kSampleTime);
  sweep->sensorLabel = "LIDAR";
  sweep->sensorModel = "Sample 2";
  sweep->sensorPose = mrpt::poses::CPose3D(0.5, 0.25, 2, -0.1, 0.05, 0.2);
  sweep->rowCount = 2;
  sweep->columnCount = 3;
  sweep->rangeResolution_m = 0.002;
  sweep->minRange_m = 0.3;
  sweep->maxRange_m = 120;
  sweep->echoes.resize(2);
  sweep->echoes[0] = {
      {1000, 0, 300'000, 5, 6, 7}, {1, 2, 3, 300, 5, 6}, {10, 20, 30, 40, 50, 60'000}, {0, 1, 2, 3, 4, 31}};
  sweep->echoes[1].range = {0, 0, 310'000, 0, 0, 0};
  sweep->nearInfrared = {100, 200, 300, 400, 500, 65'535};
  sweep->beamAltitude_rad = {0.25f, -0.25f};
  sweep->beamAzimuth_rad = {0.0625f, -0.0625f};
  sweep->beamOriginOffset_m = 0.0158;
  sweep->beamOriginHeight_m = 0.003;
  sweep->T_sensor_lidar = mrpt::poses::CPose3D(0, 0, 0.036, M_PI, 0, 0);
  sweep->columnAzimuth_rad = {0.0f, -2.0f, -4.0f};
  sweep->columnTime_ns = {0, 30'000'000, 60'000'000};
  sweep->rowTime_ns = {0, 250};
  sweep->columnValid = {1, 0, 1};
  sweep->deviceTime_s = 77.5;
  sweep->frameId = 638;
  return sweep;
}

mrpt::obs::CObservationIMU::Ptr sampleImu(core::TimeNs time) {
  auto imu = mrpt::obs::CObservationIMU::Create();
  imu->timestamp = core::toMrptTime(time);
  imu->sensorLabel = "IMU";
  imu->set(mrpt::obs::IMU_Z_ACC, 9.81);
  imu->set(mrpt::obs::IMU_WX, 0.125);
  return imu;
}

}  // namespace s2s::test
