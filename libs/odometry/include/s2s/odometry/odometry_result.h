#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "s2s/core/time.h"
#include "s2s/core/trajectory.h"
#include "s2s/core/transform.h"
#include "s2s/odometry/imu_calibration.h"

namespace s2s::odometry {

enum class OdometryStatus {
  firstScan,     ///< defines the odometry's frame
  registered,    ///< all six degrees of freedom seen by the scan
  degenerate,    ///< registered; some directions are held by the motion model alone
  deadReckoned,  ///< the scan matched too little: the pose is the prediction
  skipped        ///< the scan could not be used: no pose
};

enum class OdometryReason {
  none,
  emptyScan,          ///< no usable point
  timeNotIncreasing,  ///< ends no later than a scan before it
  tooFewMatches,      ///< hardly any point lies on a known plane
  weakGeometry        ///< see the degenerate motions
};

/// What the odometry found out from one scan.
struct OdometryResult {
  OdometryStatus status = OdometryStatus::skipped;
  OdometryReason reason = OdometryReason::none;
  core::TimeNs scanTime = 0;  ///< of the scan's first point, as given; tells which scan this is
  core::TimeNs time = 0;      ///< end of the scan: all below holds at this time

  core::Isometry T_odom_vehicle = core::Isometry::Identity();
  /// Of the pose in odom, right (body) perturbation; grows with the way travelled.
  core::Matrix6 covariance_pose = core::Matrix6::Zero();
  /// Of the motion since the last scan with a pose: what this scan adds to the drift, right perturbation at its end.
  /// See MotionAccumulator for motions over several scans.
  core::Matrix6 covariance_motion = core::Matrix6::Zero();
  /// Of the pose against the local map alone (does not grow).
  core::Matrix6 covariance_registration = core::Matrix6::Zero();

  bool hasGravity = false;                                   ///< true with an IMU, or if the vehicle floats
  Eigen::Vector3d up_odom = Eigen::Vector3d::UnitZ();        ///< estimated, against gravity; about z
  double gravitySigma_rad = 0;                               ///< of that direction
  Eigen::Vector3d velocity_odom = Eigen::Vector3d::Zero();   ///< of the vehicle's origin [m/s]
  Eigen::Vector3d gyroBias_radps = Eigen::Vector3d::Zero();  ///< in the IMU's frame
  Eigen::Vector3d accelBias_mps2 = Eigen::Vector3d::Zero();
  ImuCalibration imu;  ///< zero without IMU

  /// Motions that the scan did not see, as right perturbations of the vehicle's pose that move the scan's points by
  /// about 1 m.
  std::vector<core::Vector6> degenerateMotions;
  int iterations = 0;
  std::size_t pointCount = 0;        ///< tried for registration
  std::size_t matchCount = 0;        ///< found on a plane of the map
  std::size_t seabedMatchCount = 0;  ///< acoustic points found on a plane of the seabed's map; 0: not registered
  double residualScale = 0;          ///< residuals over their expectation; much above 1: the map does not fit

  std::size_t ownHullCount = 0, outOfRangeCount = 0, belowWaterCount = 0;  ///< returns left out

  std::vector<Eigen::Vector3f> points_vehicle;  ///< registered points, deskewed, in the vehicle's frame at `time`
  std::vector<core::TimedPose> path;            ///< T_odom_vehicle at high rate, after the last result up to `time`
};

/// Faults that the odometry met and survived.
struct OdometryFaults {
  std::size_t imuRefused = 0;  ///< not finite, or time not increasing
  std::size_t imuGaps = 0;     ///< scans that had to bridge missing IMU samples
  std::size_t imuIgnored = 0;  ///< came after the odometry had started without IMU
  std::size_t scansEmpty = 0;
  std::size_t scansTimeNotIncreasing = 0;
  std::size_t scansDeadReckoned = 0;
};

/// Relative motion over any number of scans, for the edges of a pose graph.
///
/// The errors of two registrations against the same map are not independent of what lies between: the motion's
/// covariance is that of the first pose and of the last against the map, plus the drift of the map on the way.
class MotionAccumulator {
 public:
  /// Takes a result with a pose; `skipped` ones are ignored.
  void add(const OdometryResult& result);

  struct Motion {
    core::Isometry T_from_to = core::Isometry::Identity();
    core::Matrix6 covariance = core::Matrix6::Zero();  ///< right perturbation
  };
  /// Motion from the last `restart` (or the first result) to the last result.
  Motion motion() const;
  /// The last result becomes the start of the next motion.
  void restart();

 private:
  bool hasStart_ = false;
  core::Isometry T_start_ = core::Isometry::Identity(), T_last_ = core::Isometry::Identity();
  core::Matrix6 startCovariance_ = core::Matrix6::Zero(), lastCovariance_ = core::Matrix6::Zero();
  core::Matrix6 drift_ = core::Matrix6::Zero();
};

}  // namespace s2s::odometry
