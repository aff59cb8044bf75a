#pragma once

#include <optional>
#include <string>

#include "s2s/core/option_table.h"
#include "s2s/core/transform.h"
#include "s2s/mapper/gnss_reader.h"

namespace s2s::mapper {

/// One sensor of the vessel as it appears in the rawlog.
struct SensorOptions {
  std::string label;                               ///< sensor label in the rawlog
  std::optional<core::Isometry> T_vehicle_sensor;  ///< replaces the recorded mounting when given
};

struct MapperOptions {
  SensorOptions lidar{"LIDAR", {}};
  SensorOptions imu{"IMU", {}};
  SensorOptions sonarHorizontal{"SONAR_HORIZONTAL", {}};
  SensorOptions sonarVertical{"SONAR_VERTICAL", {}};
  SensorOptions gnss{"GNSS", {}};
  GnssReaderOptions gnssReader;

  /// Recorded time less true time of a sonar's pings; taken off when they are read.
  double timeOffsetHorizontal_s = 0, timeOffsetVertical_s = 0;
  /// True sound speed in the water: ranges and bearings are corrected from the one each device used. 0: devices' own.
  double soundSpeed_mps = 0;
  /// Pings of the two sonars no further apart than this are a stereo pair (15 Hz against 10 Hz: up to 33 ms).
  double stereoPairWindow_s = 0.04;
  /// Height of the water surface in the vehicle frame when the vessel floats at rest.
  double waterline_m = 0.0;
  /// LiDAR returns lower than this above the water surface enter neither the odometry nor the map.
  double waterMargin_m = 0.15;
  /// False for vehicles on land: no water surface is estimated and nothing is cut at it.
  bool onWater = true;
  /// Records that wait between two threads; more smooths the load, less saves memory.
  int queueCapacity = 64;
};

core::OptionTable optionTable(MapperOptions& options);

}  // namespace s2s::mapper
