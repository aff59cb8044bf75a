#pragma once

#include <mrpt/maps/CSimplePointsMap.h>

#include <deque>
#include <optional>
#include <unordered_set>

#include "contestant.h"
#include "s2s/odometry/inertial_filter.h"

namespace s2s::bench {

/// The odometry with its registration replaced by MRPT's point-to-point ICP (CICP::Align3D) against a local map of
/// points: the same scans, thinning, deskew, IMU and filter. The filter starts with the state that our odometry found.
class MrptIcpOdometry : public Contestant {
 public:
  MrptIcpOdometry(std::string name, const odometry::OdometryOptions& options);

 protected:
  void takeImu(const odometry::ImuSample& sample) override;
  void takeSweep(const obs::CObservationLidarSweep& sweep) override;
  void takeEnd() override;

 private:
  void tryStart();
  void drain();
  void process(const odometry::Scan& scan);
  /// Deskewed, in the vehicle's frame at the scan's end.
  std::vector<Eigen::Vector3f> pointsOf(const odometry::Scan& scan, const std::vector<odometry::NavState>& path) const;
  void align(const std::vector<Eigen::Vector3f>& points_vehicle);
  void insert(const std::vector<Eigen::Vector3f>& points_vehicle);
  core::Isometry T_odom_vehicle() const { return filter_->state().T_odom_imu() * T_vehicle_imu_.inverse(); }

  odometry::OdometryOptions options_;
  odometry::ScanMaker maker_;
  std::unique_ptr<odometry::LidarInertialOdometry> starter_;
  std::optional<odometry::InertialFilter> filter_;
  core::Isometry T_vehicle_imu_ = core::Isometry::Identity();
  odometry::ImuBuffer imu_;
  std::deque<odometry::Scan> waiting_;
  mrpt::maps::CSimplePointsMap map_;
  std::unordered_set<std::uint64_t> taken_;  // cubes of the map that hold a point
  Eigen::Vector3d mapCentre_ = Eigen::Vector3d::Zero();
};

}  // namespace s2s::bench
