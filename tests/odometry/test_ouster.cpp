#include <gtest/gtest.h>
#include <mrpt/obs/CObservationIMU.h>

#include <filesystem>
#include <iostream>

#include "kitti_scans.h"
#include "ouster2rawlog/ouster_converter.h"
#include "s2s/obs/rawlog_reader.h"
#include "s2s/odometry/lidar_inertial_odometry.h"
#include "s2s/odometry/scan_maker.h"
#include "temp_folder.h"

namespace s2s::odometry {
namespace {

const std::string kCapture = std::string(S2S_DATA_DIR) + "/ouster/OS-1-128_v2.3.0_1024x10_lb_n3";

/// Converts the capture as a user would and gives the odometry all that it holds.
std::vector<OdometryResult> runOnCapture() {
  const test::TempFolder folder;
  tools::ouster::OusterOptions capture;
  capture.capture = kCapture + ".pcap";
  capture.metadata = std::string(S2S_DATA_DIR) + "/ouster/OS-1-128_v2.3.0_1024x10.json";
  tools::ConverterOptions conversion;
  conversion.output = folder.file("a.rawlog");
  conversion.label = "LIDAR";
  tools::ouster::convertOusterCapture(capture, conversion);

  OdometryOptions options;
  options.water.heavePrior = false;  // a car
  ScanMaker maker(options.scan);
  LidarInertialOdometry odometry(options);
  obs::RawlogReader reader(conversion.output);
  while (const auto observation = reader.next()) {
    if (const auto* sweep = dynamic_cast<const obs::CObservationLidarSweep*>(observation.get()))
      odometry.addScan(maker.fromSweep(*sweep));
    if (const auto* imu = dynamic_cast<const mrpt::obs::CObservationIMU*>(observation.get()))
      if (const auto sample = imuSampleFrom(*imu)) odometry.addImu(*sample);
  }
  odometry.finish();
  std::vector<OdometryResult> results;
  while (auto result = odometry.next()) results.push_back(std::move(*result));
  return results;
}

TEST(Ouster, ThreeDrivenSweeps_MoveAsTheirReferencePoses) {
  if (!std::filesystem::exists(kCapture + ".pcap")) GTEST_SKIP() << "no real capture " << kCapture << ".pcap";
  const auto results = runOnCapture();
  const auto reference = kitti::readPoses(kCapture + "_poses_kitti.txt");
  ASSERT_EQ(reference.size(), 3U);
  ASSERT_EQ(results.size(), 3U);
  for (std::size_t i = 1; i < 3; ++i) {
    EXPECT_EQ(results[i].status, OdometryStatus::registered);
    const core::Isometry motion = results[i - 1].T_odom_vehicle.inverse() * results[i].T_odom_vehicle;
    const core::Isometry expected = reference[i - 1].inverse() * reference[i];
    const core::Isometry error = expected.inverse() * motion;
    std::cout << "motion " << motion.translation().transpose() << ", expected " << expected.translation().transpose()
              << ", differing by " << error.translation().norm() << " m and "
              << core::logSo3(error.linear()).norm() * 180 / M_PI << " deg\n";
    // The reference is a point-to-point odometry just started: the rings of its scans on the road hold it back, and its
    // height jumps by 2 cm between two sweeps of a car. It cannot show more than that ours is right to some
    // centimetres.
    EXPECT_LT(error.translation().norm(), 0.05);
    EXPECT_LT(core::logSo3(error.linear()).norm(), 0.4 * M_PI / 180);
  }
}

}  // namespace
}  // namespace s2s::odometry
