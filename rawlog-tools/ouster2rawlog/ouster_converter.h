#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>

#include "common/conversion_report.h"
#include "common/converter_options.h"

namespace s2s::tools::ouster {

struct OusterOptions {
  std::string capture;   ///< pcap or pcapng file
  std::string metadata;  ///< JSON file
  std::string imuLabel = "IMU";
  /// Which sensor, when the capture holds several: address of the sender, and UDP port that the LiDAR packets go to.
  std::string source;
  std::optional<std::uint16_t> lidarPort;
};

/// Names in the report.
constexpr const char* kSweeps = "LiDAR sweeps";
constexpr const char* kLidarPackets = "LiDAR packets";
constexpr const char* kImuReadings = "IMU readings";

/// Writes each turn of the LiDAR as a CObservationLidarSweep and each IMU reading as a CObservationIMU. The sensor's
/// frame is Ouster's: x forward (away from the cable), z up. The IMU's pose is T_vehicle_sensor T_sensor_imu.
/// @param progress where to show progress; null for nowhere
/// @throws core::InputError, core::OutputError
ConversionReport convertOusterCapture(const OusterOptions& ouster, const ConverterOptions& options,
                                      std::ostream* progress = nullptr);

}  // namespace s2s::tools::ouster
