#include "s2s/odometry/imu_calibration.h"

#include <cmath>
#include <cstdio>

namespace s2s::odometry {

namespace {

/// Less than this is no fault: it changes no pose by a centimetre.
constexpr double kTimeOffset_s = 3e-3;
constexpr double kTurn_rad = 0.4 * M_PI / 180;
/// Standard deviations by which the data must contradict.
constexpr double kSignificance = 5.0;

template <class... Values>
std::string text(const char* format, Values... values) {
  char buffer[512];
  std::snprintf(buffer, sizeof(buffer), format, values...);
  return buffer;
}

}  // namespace

std::vector<std::string> contradictions(const ImuCalibration& imu) {
  std::vector<std::string> found;
  if (std::abs(imu.timeOffset_s) > std::max(kTimeOffset_s, kSignificance * imu.timeOffsetSigma_s))
    found.push_back(text(
        "the IMU's time stamps are %.1f ms %s than the LiDAR's for the same moment (sigma %.1f ms); this "
        "was allowed for: synchronise the clocks",
        1e3 * std::abs(imu.timeOffset_s), imu.timeOffset_s > 0 ? "later" : "earlier", 1e3 * imu.timeOffsetSigma_s));
  const Eigen::Array3d size = imu.turn_rad.array().abs();
  if ((size > (kSignificance * imu.turnSigma_rad.array()).max(kTurn_rad)).any()) {
    const Eigen::Vector3d deg = imu.turn_rad * 180 / M_PI, sigma = imu.turnSigma_rad * 180 / M_PI;
    found.push_back(
        text("IMU and LiDAR are turned against what their mountings say: by %.2f, %.2f, %.2f deg about the IMU's "
             "x, y, z axes (sigma %.2f, %.2f, %.2f); this was allowed for: check pose_imu and pose_lidar",
             deg.x(), deg.y(), deg.z(), sigma.x(), sigma.y(), sigma.z()));
  }
  return found;
}

}  // namespace s2s::odometry
