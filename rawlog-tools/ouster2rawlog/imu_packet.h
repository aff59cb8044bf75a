#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace s2s::tools::ouster {

/// A reading of the sensor's IMU in the IMU's own axes.
struct ImuReading {
  std::uint64_t time_ns = 0;  ///< device clock when the gyroscope was read; the accelerometer is some 0.2 ms earlier
  Eigen::Vector3d acceleration_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d turnRate_radps = Eigen::Vector3d::Zero();
};

/// True if a UDP payload of this size can be an IMU packet: 48 bytes (LEGACY) or, with the header of later profiles,
/// 164 bytes and 36 for each reading (ACCEL32_GYRO32_NMEA).
bool isImuPacketSize(std::size_t bytes);

/// The valid readings of a packet, in time order. `bytes` must be a size that `isImuPacketSize` takes.
std::vector<ImuReading> parseImuPacket(const std::uint8_t* packet, std::size_t bytes);

}  // namespace s2s::tools::ouster
