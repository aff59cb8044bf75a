#pragma once

#include "s2s/core/trajectory.h"
#include "s2s/odometry/acoustic_scan.h"
#include "s2s/odometry/imu_buffer.h"
#include "s2s/odometry/inertial_filter.h"
#include "s2s/odometry/odometry_result.h"
#include "s2s/odometry/options.h"
#include "s2s/odometry/plane_map.h"
#include "s2s/odometry/registration.h"
#include "s2s/odometry/scan.h"
#include "start_state.h"

namespace s2s::odometry {

/// The estimator from its first state on: takes scans in time order, with the IMU samples of their time at hand.
class ScanTracker {
 public:
  ScanTracker(const OdometryOptions& options, bool hasImu, const core::Isometry& T_vehicle_imu);

  /// State at the first scan's first point; the map is emptied.
  void start(const StartState& start);

  /// @param scan not empty, and ending after the filter's time
  /// @param acoustic scans up to the end of `scan`; those from before the last second are of no use any more
  OdometryResult track(const Scan& scan, const ImuBuffer& imu, const std::vector<AcousticScan>& acoustic);

  const InertialFilter& filter() const { return filter_; }
  const core::Isometry& T_vehicle_imu() const { return T_vehicle_imu_; }
  core::Isometry T_odom_vehicle() const { return filter_.state().T_odom_imu() * T_imu_vehicle_; }
  bool bridgedImu() const { return bridgedImu_; }

 private:
  /// A scan's thinned points: where they were measured, and after deskew.
  struct Points {
    std::vector<Eigen::Vector3f> sensor;
    std::vector<float> offset_s;
    std::vector<Eigen::Vector3f> vehicle;   // deskewed to the scan's end
    std::vector<std::uint32_t> registered;  // indices into the above
  };

  void useHeavePrior(double sinceLast_s);
  void useVelocityPrior(double sinceLast_s, const Eigen::Vector3d& angularRate_radps);
  Points thin(const Scan& scan) const;
  void deskew(const Scan& scan, const core::Trajectory& path, Points& points) const;
  void rejectBelowWater(Points& points, OdometryResult& result) const;
  BodyPoints bodyPoints(const Points& points) const;
  core::Trajectory correctedPath(const std::vector<NavState>& path, const core::Isometry& T_odom_imu_end) const;
  RegistrationResult registerScan(const Scan& scan, const std::vector<NavState>& path, Points& points) const;
  /// Takes an error of the filter's pose (position in odom, rotation in imu) to the right perturbation of the
  /// vehicle's pose.
  core::Matrix6 vehicleByImuError() const;
  /// Updates the filter by registering the acoustic points to the map of the seabed, and takes them into it.
  /// @param unseen motions that the LiDAR scan did not see: where the sonars hardly do either, nothing is believed
  void useSeabed(const std::vector<AcousticScan>& acoustic, const std::vector<NavState>& path,
                 const std::vector<core::Vector6>& unseen, OdometryResult& result);
  /// All points in the vehicle's frame at the path's end, thinned, with their variances.
  BodyPoints seabedPoints(const std::vector<AcousticScan>& acoustic, const core::Trajectory& path) const;
  void insert(const Points& points);
  void describe(const Points& points, const Eigen::Vector3d& angularRate_radps, OdometryResult& result);
  void accountDrift(const Points& points, OdometryResult& result);

  OdometryOptions options_;
  core::Isometry T_vehicle_imu_, T_imu_vehicle_;
  InertialFilter filter_;
  PlaneMap map_;
  PlaneMap seabed_;
  core::Trajectory recent_;  // T_odom_vehicle of the last moments, as finally estimated
  core::Matrix6 drift_ = core::Matrix6::Zero();
  core::Isometry T_odom_vehicle_last_ = core::Isometry::Identity();
  Eigen::Vector3d mapCentre_ = Eigen::Vector3d::Zero();
  bool bridgedImu_ = false;
  double heaveMisfit_ = 0;       // running mean of the normalised heave
  double heaveVariance_m2_ = 0;  // running mean of the squared heave
};

}  // namespace s2s::odometry
