#pragma once

#include <Eigen/Core>
#include <vector>

#include "s2s/core/time.h"
#include "s2s/core/transform.h"

namespace s2s::odometry {

/// Points of one LiDAR sweep, chosen for registration (not for the map that people take home).
struct Scan {
  core::TimeNs time = 0;                       ///< of the first firing
  double duration_s = 0;                       ///< from the first to the last firing
  std::vector<Eigen::Vector3f> points_sensor;  ///< [m]
  /// Seconds from `time`, one a point; empty: the sensor gives no times, all points count as taken at the end.
  std::vector<float> offset_s;
  core::Isometry T_vehicle_sensor = core::Isometry::Identity();

  std::size_t ownHullCount = 0;     ///< returns left out because they lie on the vessel itself
  std::size_t outOfRangeCount = 0;  ///< returns left out because they are too near, too far or not finite

  core::TimeNs endTime() const { return time + core::durationNs(duration_s); }
};

}  // namespace s2s::odometry
