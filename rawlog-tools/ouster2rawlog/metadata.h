#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "s2s/core/transform.h"

namespace s2s::tools::ouster {

/// What a sensor tells about itself in its metadata JSON. Both layouts are read: the flat one of firmware up to 2.x
/// and the one with sections (`sensor_info`, `beam_intrinsics`, …) of later firmware.
struct Metadata {
  std::string model;  ///< product line, e.g. "OS-1-128"
  std::string serialNumber;
  std::string firmware;                           ///< e.g. "v2.3.0"
  std::optional<std::uint32_t> initializationId;  ///< changes when the sensor is initialised anew
  std::string timestampMode;                      ///< e.g. "TIME_FROM_PTP_1588"; empty if not told

  std::uint32_t rows = 0;     ///< pixels a column
  std::uint32_t columns = 0;  ///< columns a full turn
  std::uint32_t columnsPerPacket = 16;
  double turnRate_hz = 10;
  std::uint32_t firstColumn = 0;  ///< azimuth window, both ends included; first > last if it spans column 0
  std::uint32_t lastColumn = 0;
  std::string lidarProfile = "LEGACY";
  bool fusaHeader = false;                          ///< packet headers of the FUSA kind
  std::optional<std::uint16_t> lidarPort, imuPort;  ///< UDP destination ports

  std::vector<double> beamAltitude_deg;
  std::vector<double> beamAzimuth_deg;  ///< clockwise seen from above, as the device tells them
  double beamOriginOffset_m = 0;        ///< of the beams' origins from the LiDAR's axis
  double beamOriginHeight_m = 0;
  core::Isometry T_sensor_lidar = core::Isometry::Identity();
  core::Isometry T_sensor_imu = core::Isometry::Identity();

  std::vector<std::string> assumed;  ///< what the file does not tell and was filled in, for the report
};

/// @param text the JSON
/// @param name its file, for errors
/// @throws core::InputError if it is no Ouster metadata or contradicts itself
Metadata parseMetadata(const std::string& text, const std::string& name);

/// @throws core::InputError if the file cannot be read, and as `parseMetadata`
Metadata loadMetadata(const std::string& path);

}  // namespace s2s::tools::ouster
