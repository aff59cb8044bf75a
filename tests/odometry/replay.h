#pragma once

#include <vector>

#include "s2s/odometry/lidar_inertial_odometry.h"
#include "synthetic.h"

/// The whole odometry on a synthetic record, compared with the truth.
namespace s2s::odometry::synthetic {

struct Record {
  World world = room();
  Path path = roomPath();
  Lidar lidar;
  core::Isometry T_vehicle_imu = core::isometryFromXyzYpr(0.1, -0.05, 0.85, 0.3, 0.05, -0.1);
  ImuNoise noise{0.002, 0.02, {0.004, -0.003, 0.002}, {0.03, -0.02, 0.01}};
  double duration_s = 12;
  bool hasImu = true;
  bool hasPointTimes = true;
  Seabed seabed;  // none: no sonars
  OdometryOptions options;
  std::uint64_t seed = 1;
  /// May change a scan or sample before it is given; false: leave it out.
  std::function<bool(Scan&)> tamperScan;
  std::function<bool(ImuSample&)> tamperImu;
};

struct Replay {
  std::vector<OdometryResult> results;
  core::Trajectory trajectory;
  OdometryFaults faults;
  bool usedImu = false;
};

Replay replay(const Record& record);

/// T_true^-1 T_estimated of the motion from the first result with a pose to result `i`.
core::Isometry errorAt(const Replay& replay, const Record& record, std::size_t i);

struct Worst {
  double translation_m = 0, rotation_rad = 0;
};
/// Over all results with a pose.
Worst worstError(const Replay& replay, const Record& record);

}  // namespace s2s::odometry::synthetic
