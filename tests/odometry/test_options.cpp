#include <gtest/gtest.h>

#include "s2s/core/error.h"
#include "s2s/odometry/lidar_inertial_odometry.h"
#include "s2s/odometry/options_table.h"

namespace s2s::odometry {
namespace {

void load(const std::string& text, OdometryOptions& options) {
  auto table = optionTable(options);
  auto ini = core::IniFile::parse("[odometry]\n" + text, "test.ini");
  table.load(ini, "odometry");
  ini.rejectUnread();
}

TEST(OdometryOptions, PrintedSection_ReadsBackToTheSame) {
  OdometryOptions options;
  options.imuUse = ImuUse::never;
  options.scan.hullBox = {-1, -2, -3, 1, 2, 3};
  options.registration.angleSigma_rad = 0.001;
  const std::string text = optionTable(options).print("odometry");
  OdometryOptions again;
  auto table = optionTable(again);
  auto ini = core::IniFile::parse(text, "printed");
  table.load(ini, "odometry");
  EXPECT_EQ(optionTable(again).print("odometry"), text);
  EXPECT_EQ(again.imuUse, ImuUse::never);
  EXPECT_EQ(again.scan.hullBox, options.scan.hullBox);
}

TEST(OdometryOptions, WrongValues_AreRefused) {
  OdometryOptions options;
  EXPECT_THROW(load("max_range_m = -3\n", options), core::ConfigError);
  EXPECT_THROW(load("imu = sometimes\n", options), core::ConfigError);
  EXPECT_THROW(load("voxel_size = 1\n", options), core::ConfigError);
}

TEST(OdometryOptions, ContradictoryRanges_AreRefused) {
  OdometryOptions options;
  options.scan.minRange_m = 10;
  options.scan.maxRange_m = 5;
  EXPECT_THROW(LidarInertialOdometry{options}, core::ConfigError);
  options = {};
  options.scan.hullBox = {1, 1, 1, 0, 2, 2};
  EXPECT_THROW(LidarInertialOdometry{options}, core::ConfigError);
}

}  // namespace
}  // namespace s2s::odometry
