#pragma once

#include <mrpt/obs/CObservationPointCloud.h>

#include <Eigen/Core>
#include <vector>

#include "s2s/core/trajectory.h"
#include "s2s/obs/CObservationLidarSweep.h"
#include "s2s/odometry/options.h"

namespace s2s::odometry {

/// Poses of a moving sensor in a frame fixed at one moment, tabulated densely over a short time so that a point costs
/// one interpolation of matrices. Between table rows the error is (turn rate * step)^2 / 8, below 1e-6 rad.
class DeskewTable {
 public:
  /// @param trajectory T_frame_vehicle, covering `first` to `last` where it can; outside it the nearest pose is held
  /// @param T_reference_frame takes that frame's coordinates to those of the result
  DeskewTable(const core::Trajectory& trajectory, const core::Isometry& T_reference_frame,
              const core::Isometry& T_vehicle_sensor, core::TimeNs first, core::TimeNs last);

  /// p_reference of a point seen `offset_s` after `first`.
  Eigen::Vector3f apply(const Eigen::Vector3f& p_sensor, float offset_s) const {
    const float x = std::min(std::max(offset_s * rowsPerSecond_, 0.0F), lastRow_);
    const auto row = std::min(static_cast<std::size_t>(x), R_.size() - 2);
    const float u = x - static_cast<float>(row);
    return ((1.0F - u) * R_[row] + u * R_[row + 1]) * p_sensor + ((1.0F - u) * t_[row] + u * t_[row + 1]);
  }

 private:
  float rowsPerSecond_ = 0, lastRow_ = 0;
  std::vector<Eigen::Matrix3f> R_;
  std::vector<Eigen::Vector3f> t_;
};

/// All usable points of a sweep, in the vehicle's frame at one moment.
struct DeskewedCloud {
  core::TimeNs time = 0;
  std::vector<Eigen::Vector3f> points_vehicle;  ///< [m]
  std::vector<float> reflectivity;              ///< as the device scales it; 0 where it gives none
  std::vector<float> sigma_m;                   ///< one standard deviation of the point, growing with range
  std::size_t ownHullCount = 0, outOfRangeCount = 0, withoutPoseCount = 0, belowWaterCount = 0;
};

/// How all points of a sweep are taken.
struct DeskewOptions {
  ScanOptions filter;  ///< range limits and hull box; strides are not used
  double rangeSigma_m = 0.02;
  double angleSigma_rad = 0.5e-3;
  /// Points lower than this along `up`, both in the trajectory's frame, are left out (the water's surface); NaN: none.
  double lowestHeight_m = std::numeric_limits<double>::quiet_NaN();
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
};

/// Every usable return of a sweep's first echo, in the vehicle's frame at `reference`.
///
/// Columns whose time lies outside the trajectory are left out and counted. If the trajectory has no pose at
/// `reference`, the cloud is empty.
/// @throws core::InputError if the sweep contradicts itself
DeskewedCloud deskewSweep(const obs::CObservationLidarSweep& sweep, const core::Trajectory& T_odom_vehicle,
                          core::TimeNs reference, const DeskewOptions& options);

/// The same of a cloud without times per point: all its points are taken at its time stamp.
DeskewedCloud deskewCloud(const mrpt::obs::CObservationPointCloud& cloud, const core::Trajectory& T_odom_vehicle,
                          core::TimeNs reference, const DeskewOptions& options);

}  // namespace s2s::odometry
