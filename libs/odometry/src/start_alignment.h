#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "s2s/odometry/acoustic_scan.h"
#include "s2s/odometry/scan.h"
#include "start_state.h"

namespace s2s::odometry {

/// A point at its own time.
struct StartPoint {
  core::TimeNs time = 0;
  Eigen::Vector3d p_imu = Eigen::Vector3d::Zero();
  double variance_m2 = 0;
};

/// Points of one kind of sensor; they make one map.
struct StartLayer {
  std::vector<StartPoint> points;
  double voxel_m = 0;
  int minPoints = 0;       ///< in a voxel
  double correlation = 1;  ///< this many residuals count as one
  double shapeShare = 0;   ///< of a plane's thickness that is shape: more points do not average it out
};

/// Returns of the scans up to `end`, thinned, each at its own time; at most some ten thousands.
StartLayer lidarLayer(const std::deque<Scan>& scans, core::TimeNs end, const core::Isometry& T_vehicle_imu,
                      const OdometryOptions& options);
/// Acoustic points of the scans, thinned.
StartLayer seabedLayer(const std::vector<AcousticScan>& scans, const core::Isometry& T_vehicle_imu,
                       const OdometryOptions& options);

/// Improves a first belief by all points of the first seconds at once: speed, biases and gravity that make them lie on
/// planes.
///
/// A filter that starts blind makes its map at a wrong speed and then finds that speed confirmed by the map. Here the
/// motion of the window follows from its start by the IMU alone, every point depends on that start through the time it
/// was seen at, and each voxel's plane (offset and two tilts) is eliminated from the points in it; so a point tells
/// only what moves it against the others of its voxel. What the noise of the normals pretends to know is taken off, as
/// in a registration. This is the bundle adjustment with eliminated planes of Liu and Zhang (BALM, RA-L 2021), for one
/// start instead of many poses. The window grows as the start gets better known.
///
/// The right speed is only found from nearby, so speeds ahead in steps of 1 m/s are tried beside the assumed one; the
/// start that puts most points on planes is taken, the assumed one unless another is better by more than chance.
/// @param prior  what is known without these points
/// @param imu    not empty
/// @return the start, level; nothing if the points do not suffice
std::optional<StartState> alignedStart(const StartState& prior, const ImuBuffer& imu, core::TimeNs end,
                                       const std::vector<StartLayer>& layers, const OdometryOptions& options);

}  // namespace s2s::odometry
