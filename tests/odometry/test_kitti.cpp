#include <gtest/gtest.h>

#include <filesystem>
#include <iostream>

#include "kitti_scans.h"
#include "s2s/odometry/lidar_inertial_odometry.h"

namespace s2s::odometry {
namespace {

const std::string kFolder = std::string(S2S_DATA_DIR) + "/kitti_scans/";

/// Poses of the sensor, T_first_i, from our odometry without IMU.
std::vector<core::Isometry> runOnScans() {
  OdometryOptions options;
  options.water.heavePrior = options.water.velocityPrior = false;  // a car
  LidarInertialOdometry odometry(options);
  std::vector<core::Isometry> poses;
  const auto drain = [&] {
    while (const auto result = odometry.next()) {
      EXPECT_NE(result->status, OdometryStatus::skipped);
      EXPECT_NE(result->status, OdometryStatus::deadReckoned);
      poses.push_back(result->T_odom_vehicle);
    }
  };
  for (int i = 0; i < 22; ++i) {
    char name[32];
    std::snprintf(name, sizeof(name), "%010d.pcd", i);
    Scan scan;
    scan.time = core::durationNs(0.1 * i);
    for (const auto& p : kitti::readBinaryPcd(kFolder + name))
      if (p.norm() > 1.0F) scan.points_sensor.push_back(p);
    odometry.addScan(std::move(scan));
    drain();
  }
  odometry.finish();
  drain();
  return poses;
}

/// The whole motion's difference: share of the way, and degrees.
struct Difference {
  double translation_percent, rotation_deg;
};
Difference wholeRunDifference(const std::vector<core::Isometry>& ours, const std::vector<core::Isometry>& reference) {
  double way_m = 0;
  for (std::size_t i = 1; i < reference.size(); ++i)
    way_m += (reference[i].translation() - reference[i - 1].translation()).norm();
  const core::Isometry ourMotion = ours.front().inverse() * ours.back();
  const core::Isometry error = (reference.front().inverse() * reference.back()).inverse() * ourMotion;
  return {100 * error.translation().norm() / way_m, core::logSo3(error.linear()).norm() * 180 / M_PI};
}

TEST(Kitti, RealScansWithoutImu_AgreeWithTwoPublicOdometries) {
  if (!std::filesystem::exists(kFolder)) GTEST_SKIP() << "no real scans in " << kFolder;
  const auto ours = runOnScans();
  ASSERT_EQ(ours.size(), 22U);
  for (const std::string reference : {"reference_kiss_icp.txt", "reference_small_gicp.txt"}) {
    const auto difference = wholeRunDifference(ours, kitti::readPoses(kFolder + reference));
    std::cout << reference << ": " << difference.translation_percent << " %, " << difference.rotation_deg << " deg\n";
    // The two references differ from each other by 0.7 % and 0.3 deg; a third odometry may differ a little more.
    EXPECT_LT(difference.translation_percent, 1.0) << reference;
    EXPECT_LT(difference.rotation_deg, 0.4) << reference;
  }
}

}  // namespace
}  // namespace s2s::odometry
