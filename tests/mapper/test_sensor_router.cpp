#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>

#include "s2s/core/error.h"
#include "s2s/mapper/sensor_router.h"
#include "s2s/obs/CObservationImagingSonar.h"
#include "s2s/obs/CObservationLidarSweep.h"

namespace s2s::mapper {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

constexpr core::TimeNs kStart = 1'733'400'000'000'000'000;

template <class Observation>
Observation labelled(const std::string& label, double time_s) {
  Observation observation;
  observation.sensorLabel = label;
  observation.timestamp = core::toMrptTime(kStart + core::durationNs(time_s));
  return observation;
}

struct SensorRouterTest : ::testing::Test {
  MapperOptions options;
  FaultLog faults;
};

TEST_F(SensorRouterTest, KnownLabels_GetTheirRoles) {
  SensorRouter router(options, faults);
  auto lidar = labelled<obs::CObservationLidarSweep>("LIDAR", 0);
  auto imu = labelled<mrpt::obs::CObservationIMU>("IMU", 0.1);
  auto sonar = labelled<obs::CObservationImagingSonar>("SONAR_VERTICAL", 0.2);
  EXPECT_EQ(router.route(lidar, "0"), Role::Lidar);
  EXPECT_EQ(router.route(imu, "1"), Role::Imu);
  EXPECT_EQ(router.route(sonar, "2"), Role::SonarVertical);
  EXPECT_EQ(router.first(), kStart);
  EXPECT_EQ(router.last(), kStart + core::durationNs(0.2));
  EXPECT_TRUE(faults.lines().empty());
}

TEST_F(SensorRouterTest, ConfiguredMounting_ReplacesTheRecordedOne) {
  options.lidar.T_vehicle_sensor = core::isometryFromXyzYpr(1, 2, 3, 0.1, 0.2, 0.3);
  SensorRouter router(options, faults);
  auto lidar = labelled<obs::CObservationLidarSweep>("LIDAR", 0);
  router.route(lidar, "0");
  EXPECT_TRUE(core::toIsometry(lidar.sensorPose).isApprox(*options.lidar.T_vehicle_sensor, 1e-12));
}

TEST_F(SensorRouterTest, TimeOffsetAndSoundSpeed_AreTakenIntoThePing) {
  options.timeOffsetVertical_s = 0.03;
  options.soundSpeed_mps = 1465.2;  // 1 % below what the device used
  SensorRouter router(options, faults);
  auto ping = labelled<obs::CObservationImagingSonar>("SONAR_VERTICAL", 1.0);
  ping.soundSpeed_mps = 1480;
  ping.rangeResolution_m = 0.02;
  ping.bearings_rad = {-0.5F, 0.5F};
  EXPECT_EQ(router.route(ping, "0"), Role::SonarVertical);
  EXPECT_EQ(core::fromMrptTime(ping.timestamp), kStart + core::durationNs(0.97));
  EXPECT_DOUBLE_EQ(ping.rangeResolution_m, 0.02 * 0.99);
  EXPECT_NEAR(std::sin(ping.bearings_rad[1]), 0.99 * std::sin(0.5), 1e-7);  // a float's resolution
  EXPECT_DOUBLE_EQ(ping.soundSpeed_mps, 1465.2);
}

TEST_F(SensorRouterTest, PingWithoutSoundSpeed_StaysAndIsReported) {
  options.soundSpeed_mps = 1465;
  SensorRouter router(options, faults);
  auto ping = labelled<obs::CObservationImagingSonar>("SONAR_HORIZONTAL", 1.0);
  ping.rangeResolution_m = 0.02;
  router.route(ping, "0");
  EXPECT_DOUBLE_EQ(ping.rangeResolution_m, 0.02);
  EXPECT_THAT(faults.lines(), Contains(HasSubstr("sound speed")));
}

TEST_F(SensorRouterTest, TimeRunsBackwards_RecordIsDroppedAndCounted) {
  SensorRouter router(options, faults);
  auto first = labelled<mrpt::obs::CObservationIMU>("IMU", 1.0);
  auto second = labelled<mrpt::obs::CObservationIMU>("IMU", 0.5);
  EXPECT_EQ(router.route(first, "0"), Role::Imu);
  EXPECT_EQ(router.route(second, "record 1"), Role::None);
  EXPECT_THAT(faults.lines(), Contains(HasSubstr("record 1")));
}

TEST_F(SensorRouterTest, OneTimeFarAhead_DropsThatRecordOnly) {
  SensorRouter router(options, faults);
  auto first = labelled<mrpt::obs::CObservationIMU>("IMU", 1.0);
  auto astray = labelled<mrpt::obs::CObservationIMU>("IMU", 4e8);
  auto next = labelled<mrpt::obs::CObservationIMU>("IMU", 1.01);
  EXPECT_EQ(router.route(first, "0"), Role::Imu);
  EXPECT_EQ(router.route(astray, "record 1"), Role::None);
  EXPECT_EQ(router.route(next, "2"), Role::Imu);
  EXPECT_EQ(router.last(), kStart + core::durationNs(1.01));
  EXPECT_THAT(faults.lines(), Contains(HasSubstr("record 1")));
}

TEST_F(SensorRouterTest, PauseOfMinutes_IsNoJump) {
  SensorRouter router(options, faults);
  auto first = labelled<mrpt::obs::CObservationIMU>("IMU", 0);
  auto later = labelled<mrpt::obs::CObservationIMU>("IMU", 1800);
  EXPECT_EQ(router.route(first, "0"), Role::Imu);
  EXPECT_EQ(router.route(later, "1"), Role::Imu);
}

TEST_F(SensorRouterTest, TwoSensorsWithOneLabel_AreAConfigError) {
  options.sonarVertical.label = options.sonarHorizontal.label;
  EXPECT_THROW(SensorRouter(options, faults), core::ConfigError);
}

TEST_F(SensorRouterTest, SoundSpeedOfNoWater_IsAConfigError) {
  options.soundSpeed_mps = 1.48;  // km/s
  EXPECT_THROW(SensorRouter(options, faults), core::ConfigError);
}

TEST_F(SensorRouterTest, WrongClassUnderTheLabel_IsNotUsed) {
  SensorRouter router(options, faults);
  auto imposter = labelled<mrpt::obs::CObservationIMU>("LIDAR", 0);
  EXPECT_EQ(router.route(imposter, "0"), Role::None);
  EXPECT_THAT(faults.lines(), Contains(HasSubstr("CObservationIMU")));
}

TEST_F(SensorRouterTest, NoLidar_ErrorNamesWhatTheRawlogHolds) {
  SensorRouter router(options, faults);
  auto other = labelled<obs::CObservationLidarSweep>("OS1", 0);
  router.route(other, "0");
  try {
    router.requireLidar("a.rawlog");
    FAIL() << "no error";
  } catch (const core::InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("a.rawlog"));
    EXPECT_THAT(e.remedy(), HasSubstr("'OS1'"));
    EXPECT_THAT(e.remedy(), HasSubstr("label_lidar"));
  }
}

}  // namespace
}  // namespace s2s::mapper
