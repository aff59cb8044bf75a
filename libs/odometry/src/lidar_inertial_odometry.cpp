#include "s2s/odometry/lidar_inertial_odometry.h"

#include "s2s/core/error.h"
#include "s2s/odometry/point_filter.h"
#include "scan_tracker.h"
#include "start_alignment.h"
#include "start_state.h"

namespace s2s::odometry {

namespace {

/// Poses of the trajectory (10 ms apart) over which the present motion is taken.
constexpr std::size_t kMotionSamples = 10;
/// An IMU that starts later than this after the first scan is not waited for.
constexpr double kLatestImu_s = 1.0;
/// The rehearsal's speed this long after the first scan tells the speed at the start.
constexpr double kEarly_s = 1.0;
/// Samples are kept this much longer, as the time offset may change.
constexpr double kImuMemory_s = 0.5;
/// So much is kept at most while no scan comes: a LiDAR that is silent for longer must not fill the memory.
constexpr double kImuPatience_s = 300.0;
/// Acoustic points are kept so long (and while the start is looked at) for the scan of their time.
constexpr double kAcousticMemory_s = 60.0;
/// Without IMU these many scans tell the speed at the start; fewer than the least tell nothing.
constexpr std::size_t kLidarOnlyRehearsal = 4, kLeastRehearsal = 3;

OdometryResult skipped(const Scan& scan, OdometryReason reason) {
  OdometryResult result;
  result.reason = reason;
  result.scanTime = scan.time;
  result.time = scan.endTime();
  result.ownHullCount = scan.ownHullCount;
  result.outOfRangeCount = scan.outOfRangeCount;
  return result;
}

}  // namespace

LidarInertialOdometry::LidarInertialOdometry(const OdometryOptions& options) : options_(options) {
  const PointFilter checkedHere(options.scan, core::Isometry::Identity());
  if (options.scan.minRange_m >= options.scan.maxRange_m)
    throw core::ConfigError("the least range is not below the greatest", "[odometry] min_range_m, max_range_m",
                            "give a greatest range above the least");
}
LidarInertialOdometry::~LidarInertialOdometry() = default;
LidarInertialOdometry::LidarInertialOdometry(LidarInertialOdometry&&) noexcept = default;
LidarInertialOdometry& LidarInertialOdometry::operator=(LidarInertialOdometry&&) noexcept = default;

bool LidarInertialOdometry::usesImu() const { return tracker_ && tracker_->filter().hasImu(); }

void LidarInertialOdometry::addImu(const ImuSample& sample) {
  if (options_.imuUse == ImuUse::never || (tracker_ && !usesImu()))
    ++faults_.imuIgnored;
  else if (!imu_.add(sample))
    ++faults_.imuRefused;
  else if (waiting_.empty())
    imu_.forgetBefore(sample.time - core::durationNs(kImuPatience_s));
}

void LidarInertialOdometry::addScan(Scan scan) { waiting_.push_back(std::move(scan)); }

void LidarInertialOdometry::addAcoustic(AcousticScan scan) {
  if (!options_.seabed.enabled) return;
  const core::TimeNs oldest = scan.time - core::durationNs(kAcousticMemory_s + options_.initialisation_s);
  acoustic_.push_back(std::move(scan));
  while (acoustic_.front().time < oldest) acoustic_.pop_front();
}

core::Isometry LidarInertialOdometry::expectedMotion(core::TimeNs from, core::TimeNs to) const {
  const auto& poses = trajectory_.poses();
  if (poses.size() < 2) return core::Isometry::Identity();
  const auto& last = poses.back();
  const auto& before = poses[poses.size() - std::min<std::size_t>(poses.size(), kMotionSamples)];
  const double share = core::secondsBetween(from, to) / core::secondsBetween(before.time, last.time);
  return core::interpolate(core::Isometry::Identity(), before.T.inverse() * last.T, share);
}

std::optional<OdometryResult> LidarInertialOdometry::next() {
  if (waiting_.empty()) return std::nullopt;
  const Scan& scan = waiting_.front();
  OdometryResult result;
  if (scan.points_sensor.empty()) {
    ++faults_.scansEmpty;
    result = skipped(scan, OdometryReason::emptyScan);
  } else if (scan.endTime() <= lastScanEnd_) {
    ++faults_.scansTimeNotIncreasing;
    result = skipped(scan, OdometryReason::timeNotIncreasing);
  } else {
    if (!tracker_ && !tryStart()) return std::nullopt;
    if (!isReady(scan)) return std::nullopt;
    result = process(scan);
  }
  waiting_.pop_front();
  return result;
}

bool LidarInertialOdometry::isReady(const Scan& scan) const {
  if (isFinished_ || !usesImu()) return true;
  const double offset_s = std::max(0.0, tracker_->filter().state().timeOffset_s);
  if (!imu_.empty() && imu_.lastTime() >= scan.endTime() + core::durationNs(offset_s)) return true;
  return core::secondsBetween(scan.endTime(), waiting_.back().endTime()) > options_.maxImuDelay_s;
}

OdometryResult LidarInertialOdometry::process(const Scan& scan) {
  std::vector<AcousticScan> acoustic;
  while (!acoustic_.empty() && acoustic_.front().time <= scan.endTime()) {
    acoustic.push_back(std::move(acoustic_.front()));
    acoustic_.pop_front();
  }
  OdometryResult result = tracker_->track(scan, imu_, acoustic);
  lastScanEnd_ = scan.endTime();
  if (tracker_->bridgedImu()) ++faults_.imuGaps;
  if (result.status == OdometryStatus::deadReckoned) ++faults_.scansDeadReckoned;
  for (const auto& pose : result.path) trajectory_.append(pose.time, pose.T);
  if (!imu_.empty()) imu_.forgetBefore(scan.endTime() - core::durationNs(kImuMemory_s));
  return result;
}

std::vector<AcousticScan> LidarInertialOdometry::acousticBetween(core::TimeNs after, core::TimeNs until) const {
  std::vector<AcousticScan> scans;
  for (const auto& scan : acoustic_)
    if (scan.time > after && scan.time <= until) scans.push_back(scan);
  return scans;
}

StartState LidarInertialOdometry::rehearsedStart(const StartState& rough, const core::Isometry& T_vehicle_imu,
                                                 bool hasImu, double duration_s) const {
  const Scan& first = waiting_.front();
  const core::TimeNs end = first.endTime() + core::durationNs(duration_s);
  ScanTracker rehearsal(options_, hasImu, T_vehicle_imu);
  rehearsal.start(rough);
  std::optional<InertialFilter> early;
  std::size_t rehearsed = 0;
  core::TimeNs lastEnd = first.time;
  for (const Scan& scan : waiting_) {
    if (scan.endTime() > end || (!hasImu && rehearsed == kLidarOnlyRehearsal)) break;
    if (scan.points_sensor.empty() || scan.endTime() <= lastEnd) continue;
    rehearsal.track(scan, imu_, acousticBetween(lastEnd, scan.endTime()));
    lastEnd = scan.endTime();
    ++rehearsed;
    if (!early && core::secondsBetween(first.time, lastEnd) >= kEarly_s) early = rehearsal.filter();
  }
  if (rehearsed < kLeastRehearsal) return rough;
  return refinedStart(rough, early.value_or(rehearsal.filter()), rehearsal.filter(), imu_, options_);
}

StartState LidarInertialOdometry::aligned(const StartState& rough, const StartState& rehearsed,
                                          const core::Isometry& T_vehicle_imu) const {
  const core::TimeNs end = waiting_.front().endTime() + core::durationNs(options_.initialisation_s);
  const std::vector<StartLayer> layers{lidarLayer(waiting_, end, T_vehicle_imu, options_),
                                       seabedLayer(acousticBetween(rough.state.time, end), T_vehicle_imu, options_)};
  return alignedStart(beforeAlignment(rough, rehearsed), imu_, std::min(end, waiting_.back().endTime()), layers,
                      options_)
      .value_or(rehearsed);
}

bool LidarInertialOdometry::tryStart() {
  const Scan& first = waiting_.front();
  const core::TimeNs windowEnd = first.endTime() + core::durationNs(options_.initialisation_s);
  const bool scansSuffice = waiting_.back().endTime() >= windowEnd;
  const bool imuSuffices = !imu_.empty() && imu_.lastTime() >= windowEnd;
  const bool mayUseImu = options_.imuUse != ImuUse::never;
  const bool lidarOnlyReady = !mayUseImu && waiting_.size() >= kLidarOnlyRehearsal;
  const bool imuIsLate =
      scansSuffice && core::secondsBetween(windowEnd, waiting_.back().endTime()) > options_.maxImuDelay_s;
  if (!isFinished_ && !lidarOnlyReady && !imuSuffices && !imuIsLate) return false;

  const bool hasImu =
      mayUseImu && !imu_.empty() && core::secondsBetween(first.endTime(), imu_.samples().front().time) < kLatestImu_s;
  if (!hasImu) {
    faults_.imuIgnored += imu_.samples().size();
    imu_ = ImuBuffer();
  }
  const core::Isometry T_vehicle_imu = hasImu ? imu_.samples().front().T_vehicle_imu : core::Isometry::Identity();
  StartState rough =
      hasImu ? inertialStart(imu_, first.time, windowEnd, options_) : lidarOnlyStart(first.time, options_);
  if (rough.isStatic) {
    const StartState moving = inEvenMotion(rough, options_);
    if (deniesRest(rehearsedStart(moving, T_vehicle_imu, hasImu, kEarly_s))) rough = moving;
  }
  tracker_ = std::make_unique<ScanTracker>(options_, hasImu, T_vehicle_imu);
  StartState start = rehearsedStart(rough, T_vehicle_imu, hasImu, options_.initialisation_s);
  if (start.isSpeedOpen) start = aligned(rough, start, T_vehicle_imu);
  tracker_->start(start);
  trajectory_.append(first.time, tracker_->T_odom_vehicle());
  return true;
}

}  // namespace s2s::odometry
