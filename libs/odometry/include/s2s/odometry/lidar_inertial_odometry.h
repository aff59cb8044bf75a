#pragma once

#include <deque>
#include <optional>

#include "s2s/core/trajectory.h"
#include "s2s/odometry/acoustic_scan.h"
#include "s2s/odometry/imu_buffer.h"
#include "s2s/odometry/odometry_result.h"
#include "s2s/odometry/options.h"
#include "s2s/odometry/scan.h"

namespace s2s::odometry {

class ScanTracker;
struct StartState;

/// Motion of the vehicle from LiDAR scans and, where there is one, an IMU.
///
/// Give it all samples and scans in the order of their time stamps, and take results as they become ready:
///
///     odometry.addScan(scan);            // or addImu(sample)
///     while (auto result = odometry.next()) ...
///     ...
///     odometry.finish();                 // nothing more will come
///     while (auto result = odometry.next()) ...
///
/// A scan is stamped with its first point, so the IMU samples of its own time arrive after it: it waits for them, not
/// longer than `maxImuDelay_s`. The first results come after `initialisation_s`. Every scan gives one result, in order.
///
/// The odometry's frame has its origin at the vehicle's first pose. With an IMU its z axis is up and its x axis is the
/// vehicle's heading there; without, it is the vehicle's first frame.
///
/// Data faults never throw; they are counted in `faults`. Not for use from several threads at once.
class LidarInertialOdometry {
 public:
  /// @throws core::ConfigError if an option contradicts another
  explicit LidarInertialOdometry(const OdometryOptions& options);
  ~LidarInertialOdometry();
  LidarInertialOdometry(LidarInertialOdometry&&) noexcept;
  LidarInertialOdometry& operator=(LidarInertialOdometry&&) noexcept;

  void addImu(const ImuSample& sample);
  void addScan(Scan scan);
  /// Points of the sonars; used with the scan during which they were measured, or the next one if they come too late.
  void addAcoustic(AcousticScan scan);
  /// The next scan's result, or nothing until more data (or `finish`) comes.
  std::optional<OdometryResult> next();
  /// No more data will come: scans that wait are processed with what there is.
  void finish() { isFinished_ = true; }

  /// T_odom_vehicle at the IMU's rate (without IMU: every 10 ms), from the first scan's first point to the last
  /// result's time.
  const core::Trajectory& trajectory() const { return trajectory_; }
  /// Frees memory; poses from `time` on stay available.
  void forgetTrajectoryBefore(core::TimeNs time) { trajectory_.forgetBefore(time); }

  bool usesImu() const;

  /// Motion from `from` to `to`, moments not far after the last result: T_from_to if speed and turn rate stay as they
  /// were; no motion before the first result.
  core::Isometry expectedMotion(core::TimeNs from, core::TimeNs to) const;

  const OdometryFaults& faults() const { return faults_; }

 private:
  bool isReady(const Scan& scan) const;
  bool tryStart();
  StartState rehearsedStart(const StartState& rough, const core::Isometry& T_vehicle_imu, bool hasImu,
                            double duration_s) const;
  StartState aligned(const StartState& rough, const StartState& rehearsed, const core::Isometry& T_vehicle_imu) const;
  std::vector<AcousticScan> acousticBetween(core::TimeNs after, core::TimeNs until) const;
  OdometryResult process(const Scan& scan);

  OdometryOptions options_;
  ImuBuffer imu_;
  std::deque<Scan> waiting_;
  std::deque<AcousticScan> acoustic_;  // in order of time
  std::unique_ptr<ScanTracker> tracker_;
  core::Trajectory trajectory_;
  OdometryFaults faults_;
  core::TimeNs lastScanEnd_ = std::numeric_limits<core::TimeNs>::min();
  bool isFinished_ = false;
};

}  // namespace s2s::odometry
