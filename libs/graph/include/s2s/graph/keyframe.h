#pragma once

#include <optional>

#include "s2s/core/time.h"
#include "s2s/graph/cloud.h"

namespace s2s::graph {

/// Direction of gravity at a keyframe, as the odometry's filter knows it.
struct GravityMeasurement {
  Eigen::Vector3d up_vehicle = Eigen::Vector3d::UnitZ();  ///< unit vector against gravity, in the vehicle frame
  double sigma_rad = 0.005;                               ///< about each horizontal axis
};

/// What the odometry gives for a keyframe.
struct KeyframeInput {
  core::TimeNs time = 0;
  core::Isometry T_odom_vehicle = core::Isometry::Identity();
  /// Covariance of the motion since the previous keyframe: body perturbation at this keyframe, translation [m] before
  /// rotation [rad]. Unused at the first keyframe.
  core::Matrix6 motionCovariance = core::Matrix6::Zero();
  /// Deskewed points above the water in the vehicle frame; GraphSlam keeps a thinned copy.
  Cloud cloud_vehicle;
  std::optional<GravityMeasurement> gravity;
};

struct Keyframe {
  int id = 0;  ///< position in GraphSlam::keyframes()
  core::TimeNs time = 0;
  core::Isometry T_odom_vehicle = core::Isometry::Identity();  ///< as given
  core::Isometry T_map_vehicle = core::Isometry::Identity();   ///< as optimised
};

/// A GNSS position, with what the odometry knew at that time.
struct GnssFix {
  core::TimeNs time = 0;
  Eigen::Vector3d p_enu = Eigen::Vector3d::Zero();  ///< antenna in a local east-north-up frame [m]
  Eigen::Vector3d sigma_m = Eigen::Vector3d(2, 2, 4);
  core::Isometry T_odom_vehicle = core::Isometry::Identity();  ///< at the time of the fix
  Eigen::Vector3d p_vehicle_antenna = Eigen::Vector3d::Zero();
};

}  // namespace s2s::graph
