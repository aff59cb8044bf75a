#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "s2s/core/time.h"
#include "s2s/core/trajectory.h"
#include "s2s/core/transform.h"
#include "s2s/graph/keyframe.h"
#include "s2s/map/scan.h"
#include "s2s/mapper/stereo_pairer.h"
#include "s2s/sonar/leading_edge.h"

namespace s2s::mapper {

/// What the stages of the mapper hand on. Poses are T_odom_vehicle throughout: the odometry's own, never corrected.

/// A sweep that became a keyframe.
struct KeyframeData {
  std::uint64_t id = 0;
  core::TimeNs time = 0;
  core::Isometry T_odom_vehicle = core::Isometry::Identity();
  core::Matrix6 motionCovariance = core::Matrix6::Zero();  ///< of the motion since the previous keyframe
  bool hasGravity = false;
  Eigen::Vector3d up_vehicle = Eigen::Vector3d::UnitZ();
  double gravitySigma_rad = 0;
  std::vector<Eigen::Vector3f> registrationPoints_vehicle;  ///< few, for loop closures
  std::vector<map::ScanPoint> points;                       ///< all, for the map
};

/// Progress of the odometry after one sweep, or, where no sweep has given a pose for long, what it gave up.
struct OdometryUpdate {
  std::vector<core::TimedPose> path;       ///< T_odom_vehicle at high rate since the last update
  core::TimeNs sweepTime = 0;              ///< of the first point of the sweep
  std::shared_ptr<KeyframeData> keyframe;  ///< null if the sweep is none
  std::vector<StereoScan> stereo;          ///< points of the pairs of pings completed since the last update
  std::vector<graph::GnssFix> fixes;       ///< whose time the path has reached
  core::TimeNs abandonedUntil = 0;         ///< pings up to this time will not get a pose any more; 0: nothing new
};

/// What a ping, or a pair of pings, adds to the map.
struct SonarScan {
  map::Layer layer = map::Layer::Stereo;
  core::TimeNs time = 0;
  core::Isometry T_odom_vehicle = core::Isometry::Identity();
  std::vector<map::ScanPoint> points;  ///< of the stereo layer
  core::Isometry T_vehicle_sonar = core::Isometry::Identity();
  sonar::LineScan line;  ///< of the line-scan layers, with T_vehicle_sonar
};

}  // namespace s2s::mapper
