#pragma once

#include <mrpt/obs/CObservation.h>

#include <cstdint>
#include <deque>
#include <functional>

#include "s2s/graph/keyframe_policy.h"
#include "s2s/mapper/fault_log.h"
#include "s2s/mapper/gnss_reader.h"
#include "s2s/mapper/mapper_options.h"
#include "s2s/mapper/messages.h"
#include "s2s/mapper/water_level.h"
#include "s2s/odometry/deskew.h"
#include "s2s/odometry/lidar_inertial_odometry.h"
#include "s2s/odometry/scan_maker.h"

namespace s2s::mapper {

/// What the odometry needs of a pair of pings.
odometry::AcousticScan acousticScan(const StereoScan& scan);

/// First stage: IMU samples and LiDAR sweeps in, odometry out, one update a sweep; sweeps far enough from the last
/// keyframe come with all their points, deskewed. Pairs of pings are triangulated here, because the odometry registers
/// what the sonars see beside what the LiDAR sees. GNSS fixes pass through and get the pose of their time.
class OdometryStage {
 public:
  struct Options {
    MapperOptions mapper;
    odometry::OdometryOptions odometry;
    graph::KeyframePolicyOptions keyframes;
    odometry::DeskewOptions deskew;
    sonar::SonarOptions sonar;
  };
  using Output = std::function<void(OdometryUpdate)>;

  OdometryStage(const Options& options, FaultLog& faults, Output output);

  void addImu(const mrpt::obs::CObservation& observation);
  /// A sweep or a point cloud.
  void addLidar(const mrpt::obs::CObservation::Ptr& observation);
  /// A ping; waits for its image where a pair is complete.
  void addPing(PendingPing ping);
  /// A record of the GNSS receiver.
  void addGnss(const mrpt::obs::CObservation& observation);
  /// Nothing more comes: processes what waits.
  void finish();

  /// T_odom_vehicle at the end of every sweep that has a pose.
  const core::Trajectory& sweepPoses() const { return sweepPoses_; }
  /// Origin of the frame of the GNSS fixes, once there was one.
  const std::optional<GeodeticPosition>& gnssOrigin() const { return gnssReader_.origin(); }
  std::uint64_t sweepCount() const { return sweepCount_; }

 private:
  void drain();
  void addFix(graph::GnssFix fix);
  void use(std::vector<StereoScan> scans);
  /// Gives up pings that no sweep gave a pose for long.
  void abandonBefore(core::TimeNs newestPing);
  void handle(const odometry::OdometryResult& result);
  std::shared_ptr<KeyframeData> makeKeyframe(const odometry::OdometryResult& result,
                                             const mrpt::obs::CObservation& sweep);
  odometry::DeskewedCloud deskewed(const mrpt::obs::CObservation& sweep, core::TimeNs reference,
                                   const odometry::DeskewOptions& options) const;
  /// The waiting fixes that the trajectory covers, with their poses.
  std::vector<graph::GnssFix> placedFixes(core::TimeNs until);
  void reportFaults();

  Options options_;
  FaultLog& faults_;
  Output output_;
  odometry::ScanMaker scanMaker_;
  odometry::LidarInertialOdometry odometry_;
  StereoPairer pairer_;
  std::vector<StereoScan> stereo_;  // not handed on yet
  odometry::MotionAccumulator motion_;
  graph::KeyframePolicy keyframePolicy_;
  std::deque<mrpt::obs::CObservation::Ptr> waiting_;  // sweeps whose pose is not known yet
  GnssReader gnssReader_;
  std::deque<graph::GnssFix> waitingFixes_;
  core::TimeNs posesUntil_ = 0;  // pings up to this time have a pose or were given up; 0: none yet
  core::Trajectory sweepPoses_;
  WaterLevel water_;
  odometry::ImuCalibration imuCalibration_;  // as found so far
  std::uint64_t keyframeCount_ = 0, sweepCount_ = 0;
};

}  // namespace s2s::mapper
