#include "s2s/mapper/odometry_stage.h"

#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <utility>

#include "s2s/core/error.h"

namespace s2s::mapper {

namespace {

/// Time that the odometry's trajectory is kept for sweeps that still wait to be deskewed.
constexpr double kTrajectoryMemory_s = 5.0;
/// Pings and fixes wait this long for a pose (and while the odometry looks at its start): a LiDAR that is silent for
/// longer, or a rawlog without one, must not fill the memory with them.
constexpr double kPatience_s = 60.0;
/// Pings are given up in portions of this.
constexpr double kPingPortion_s = 1.0;

odometry::Scan makeScan(odometry::ScanMaker& maker, const mrpt::obs::CObservation& observation) {
  if (const auto* sweep = dynamic_cast<const obs::CObservationLidarSweep*>(&observation))
    return maker.fromSweep(*sweep);
  return maker.fromCloud(dynamic_cast<const mrpt::obs::CObservationPointCloud&>(observation));
}

std::vector<map::ScanPoint> scanPoints(const odometry::DeskewedCloud& cloud) {
  std::vector<map::ScanPoint> points(cloud.points_vehicle.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = {cloud.points_vehicle[i], cloud.reflectivity[i], cloud.sigma_m[i]};
  return points;
}

}  // namespace

odometry::AcousticScan acousticScan(const StereoScan& scan) {
  odometry::AcousticScan acoustic;
  acoustic.time = scan.time;
  acoustic.points_vehicle.reserve(scan.points.size());
  acoustic.sigma_m.reserve(scan.points.size());
  for (const auto& point : scan.points) {
    acoustic.points_vehicle.push_back(point.p_vehicle);
    acoustic.sigma_m.push_back(point.sigma_m);
  }
  return acoustic;
}

OdometryStage::OdometryStage(const Options& options, FaultLog& faults, Output output)
    : options_(options),
      faults_(faults),
      output_(std::move(output)),
      scanMaker_(options.odometry.scan),
      odometry_(options.odometry),
      pairer_(options.sonar, options.mapper.stereoPairWindow_s,
              [this](core::TimeNs from, core::TimeNs to) { return odometry_.expectedMotion(from, to); }),
      keyframePolicy_(options.keyframes),
      gnssReader_(options.mapper.gnssReader) {}

void OdometryStage::addImu(const mrpt::obs::CObservation& observation) {
  const auto sample = odometry::imuSampleFrom(dynamic_cast<const mrpt::obs::CObservationIMU&>(observation));
  if (!sample) {
    faults_.add("IMU records without all of three rates and three accelerations were dropped",
                core::formatUtc(core::fromMrptTime(observation.timestamp)));
    return;
  }
  odometry_.addImu(*sample);
  drain();
}

void OdometryStage::addLidar(const mrpt::obs::CObservation::Ptr& observation) {
  try {
    odometry_.addScan(makeScan(scanMaker_, *observation));
  } catch (const core::InputError& e) {
    faults_.add("unusable LiDAR sweeps were dropped: " + e.fault(),
                core::formatUtc(core::fromMrptTime(observation->timestamp)));
    return;
  }
  waiting_.push_back(observation);
  drain();
}

void OdometryStage::addGnss(const mrpt::obs::CObservation& observation) {
  if (auto fix = gnssReader_.read(dynamic_cast<const mrpt::obs::CObservationGPS&>(observation)))
    addFix(std::move(*fix));
  else
    faults_.add("GNSS records without a valid position were not used",
                core::formatUtc(core::fromMrptTime(observation.timestamp)));
}

void OdometryStage::addFix(graph::GnssFix fix) {
  const core::TimeNs oldest = fix.time - core::durationNs(kPatience_s + options_.odometry.initialisation_s);
  waitingFixes_.push_back(std::move(fix));
  while (waitingFixes_.front().time < oldest) waitingFixes_.pop_front();
}

void OdometryStage::addPing(PendingPing ping) {
  const core::TimeNs time = ping.time;
  use(pairer_.add(std::move(ping)));
  abandonBefore(time);
}

void OdometryStage::abandonBefore(core::TimeNs newestPing) {
  const core::TimeNs patience = core::durationNs(kPatience_s + options_.odometry.initialisation_s);
  if (posesUntil_ == 0) posesUntil_ = newestPing;
  if (newestPing - posesUntil_ < patience + core::durationNs(kPingPortion_s)) return;
  posesUntil_ = newestPing - patience;
  stereo_.erase(stereo_.begin(), std::find_if(stereo_.begin(), stereo_.end(),
                                              [this](const StereoScan& scan) { return scan.time > posesUntil_; }));
  OdometryUpdate update;
  update.abandonedUntil = posesUntil_;
  output_(std::move(update));
}

void OdometryStage::use(std::vector<StereoScan> scans) {
  for (auto& scan : scans) {
    odometry_.addAcoustic(acousticScan(scan));
    stereo_.push_back(std::move(scan));
  }
}

void OdometryStage::finish() {
  use(pairer_.finish());
  odometry_.finish();
  drain();
  reportFaults();
}

void OdometryStage::drain() {
  while (const auto result = odometry_.next()) handle(*result);
}

void OdometryStage::handle(const odometry::OdometryResult& result) {
  // Every scan gives one result, in order.
  const auto sweep = waiting_.front();
  waiting_.pop_front();
  ++sweepCount_;

  OdometryUpdate update;
  update.sweepTime = result.scanTime;
  update.stereo = std::exchange(stereo_, {});
  if (result.status != odometry::OdometryStatus::skipped) {
    update.path = result.path;
    motion_.add(result);
    imuCalibration_ = result.imu;
    sweepPoses_.append(result.time, result.T_odom_vehicle);
    posesUntil_ = std::max(posesUntil_, result.time);
    water_.add(result.time, result.T_odom_vehicle * Eigen::Vector3d(0, 0, options_.mapper.waterline_m));
    if (keyframePolicy_.accept(result.T_odom_vehicle)) update.keyframe = makeKeyframe(result, *sweep);
    update.fixes = placedFixes(result.time);
    odometry_.forgetTrajectoryBefore(result.time - core::durationNs(kTrajectoryMemory_s));
  }
  output_(std::move(update));
}

std::vector<graph::GnssFix> OdometryStage::placedFixes(core::TimeNs until) {
  std::vector<graph::GnssFix> placed;
  while (!waitingFixes_.empty() && waitingFixes_.front().time <= until) {
    graph::GnssFix& fix = waitingFixes_.front();
    // Fixes from before the first pose have no place in the map.
    if (const auto T_odom_vehicle = odometry_.trajectory().at(fix.time)) {
      fix.T_odom_vehicle = *T_odom_vehicle;
      placed.push_back(std::move(fix));
    }
    waitingFixes_.pop_front();
  }
  return placed;
}

std::shared_ptr<KeyframeData> OdometryStage::makeKeyframe(const odometry::OdometryResult& result,
                                                          const mrpt::obs::CObservation& sweep) {
  auto keyframe = std::make_shared<KeyframeData>();
  keyframe->id = keyframeCount_++;
  keyframe->time = result.time;
  keyframe->T_odom_vehicle = result.T_odom_vehicle;
  keyframe->motionCovariance = motion_.motion().covariance;
  motion_.restart();
  keyframe->hasGravity = result.hasGravity;
  keyframe->up_vehicle = result.T_odom_vehicle.linear().transpose() * result.up_odom;
  keyframe->gravitySigma_rad = result.gravitySigma_rad;
  odometry::DeskewOptions options = options_.deskew;
  options.filter = options_.odometry.scan;
  options.up = result.up_odom;
  if (options_.mapper.onWater) options.lowestHeight_m = water_.height_m(options.up) + options_.mapper.waterMargin_m;
  keyframe->points = scanPoints(deskewed(sweep, result.time, options));
  for (const Eigen::Vector3f& p : result.points_vehicle)
    if (!(options.up.dot(result.T_odom_vehicle * p.cast<double>()) < options.lowestHeight_m))
      keyframe->registrationPoints_vehicle.push_back(p);
  return keyframe;
}

odometry::DeskewedCloud OdometryStage::deskewed(const mrpt::obs::CObservation& sweep, core::TimeNs reference,
                                                const odometry::DeskewOptions& options) const {
  if (const auto* organised = dynamic_cast<const obs::CObservationLidarSweep*>(&sweep))
    return odometry::deskewSweep(*organised, odometry_.trajectory(), reference, options);
  return odometry::deskewCloud(dynamic_cast<const mrpt::obs::CObservationPointCloud&>(sweep), odometry_.trajectory(),
                               reference, options);
}

void OdometryStage::reportFaults() {
  for (const auto& contradiction : odometry::contradictions(imuCalibration_)) faults_.add(contradiction);
  const auto& f = odometry_.faults();
  faults_.add("IMU samples refused (not finite, or time not increasing)", {}, f.imuRefused);
  faults_.add("sweeps that had to bridge missing IMU samples", {}, f.imuGaps);
  faults_.add("IMU samples that came after the odometry had started without IMU", {}, f.imuIgnored);
  faults_.add("sweeps without a usable point", {}, f.scansEmpty);
  faults_.add("sweeps whose time does not increase", {}, f.scansTimeNotIncreasing);
  faults_.add("sweeps that matched too little: their pose is the prediction of the motion model", {},
              f.scansDeadReckoned);
}

}  // namespace s2s::mapper
