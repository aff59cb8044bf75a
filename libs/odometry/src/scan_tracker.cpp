#include "scan_tracker.h"

#include <algorithm>

#include "s2s/odometry/deskew.h"
#include "s2s/odometry/downsample.h"

namespace s2s::odometry {

namespace {

using core::Isometry;
using core::Matrix6;
using Eigen::Vector3d;

/// A correction that moves a point at this range by more than `kRedeskew_m` is worth a second deskew.
constexpr double kRedeskewRange_m = 30.0;
constexpr double kRedeskew_m = 0.01;
/// Standard deviations of the attitude that are allowed for where the water's surface is told from a low shore, and the
/// most that is allowed for: near the vessel more would let the water in.
constexpr double kTiltDoubt = 2.0;
constexpr double kMostTiltDoubt_rad = 4.0e-3;
/// Overlap of scans that deskewing allows for.
constexpr double kRecent_s = 1.0;

/// Heaves over which the misfit of the floating height is averaged, and the level's uncertainty when it is given up.
constexpr double kMisfitHeaves = 5.0;
constexpr double kLostLevel_m = 1.0;

/// Time over which the size of the heaves is learnt, how much larger it is taken, and the least share of what the
/// options allow.
constexpr double kHeaveMemory_s = 20.0;
constexpr double kHeaveMargin = 1.5;
constexpr double kLeastHeaveShare = 0.2;

/// Ad(T) for (translation, rotation): T exp(d) = exp(Ad(T) d) T.
Matrix6 adjoint(const Isometry& T) {
  Matrix6 A = Matrix6::Zero();
  A.topLeftCorner<3, 3>() = A.bottomRightCorner<3, 3>() = T.linear();
  A.topRightCorner<3, 3>() = core::skew(T.translation()) * T.linear();
  return A;
}

double pointVariance(double range_m, const RegistrationOptions& options) {
  const double across = options.angleSigma_rad * range_m;
  return options.rangeSigma_m * options.rangeSigma_m + across * across;
}

}  // namespace

ScanTracker::ScanTracker(const OdometryOptions& options, bool hasImu, const Isometry& T_vehicle_imu)
    : options_(options),
      T_vehicle_imu_(T_vehicle_imu),
      T_imu_vehicle_(T_vehicle_imu.inverse()),
      filter_(options.imu, options.motion, hasImu),
      map_(options.map),
      seabed_(options.seabed.map) {}

void ScanTracker::start(const StartState& start) {
  filter_.reset(start.state, start.covariance);
  const double heave_m = start.heaveSigma_m > 0 ? start.heaveSigma_m : options_.water.heaveSigma_m;
  heaveVariance_m2_ = heave_m * heave_m;
  map_.clear();
  seabed_.clear();
  drift_.setZero();
  recent_ = core::Trajectory({{start.state.time, T_odom_vehicle()}});
  T_odom_vehicle_last_ = T_odom_vehicle();
  mapCentre_ = T_odom_vehicle_last_.translation();
}

OdometryResult ScanTracker::track(const Scan& scan, const ImuBuffer& imu, const std::vector<AcousticScan>& acoustic) {
  OdometryResult result;
  result.scanTime = scan.time;
  result.time = scan.endTime();
  result.ownHullCount = scan.ownHullCount;
  result.outOfRangeCount = scan.outOfRangeCount;

  const auto steps =
      imu.steps(filter_.state().time, scan.endTime(), options_.imu.maxGap_s, filter_.state().timeOffset_s);
  bridgedImu_ = filter_.hasImu() &&
                std::any_of(steps.begin(), steps.end(), [](const MotionStep& step) { return !step.isMeasured; });
  std::vector<NavState> path{filter_.state()};
  filter_.propagate(steps, &path);

  if (filter_.knowsUp() && options_.water.heavePrior && !map_.empty())
    useHeavePrior(core::secondsBetween(path.front().time, path.back().time));
  if (filter_.hasImu() && options_.water.velocityPrior && !steps.empty())
    useVelocityPrior(core::secondsBetween(path.front().time, path.back().time), steps.back().angularRate_radps);

  Points points = thin(scan);
  deskew(scan, correctedPath(path, filter_.state().T_odom_imu()), points);
  rejectBelowWater(points, result);
  result.pointCount = points.registered.size();

  std::vector<core::Vector6> unseen;
  if (map_.empty()) {
    result.status = OdometryStatus::firstScan;
  } else {
    const RegistrationResult fit = registerScan(scan, path, points);
    result.iterations = fit.iterations;
    result.matchCount = fit.matches;
    result.residualScale = fit.residualScale;
    result.status = OdometryStatus::registered;
    if (fit.end == RegistrationEnd::tooFewMatches) {
      result.status = OdometryStatus::deadReckoned;
      result.reason = OdometryReason::tooFewMatches;
    } else {
      filter_.setPosePosterior(fit.pose.T_map_body, fit.pose.covariance);
      if (!fit.degenerateMotions.empty()) {
        result.status = OdometryStatus::degenerate;
        result.reason = OdometryReason::weakGeometry;
      }
    }
    unseen = fit.degenerateMotions;
    const Matrix6 toVehicle = vehicleByImuError();
    for (const auto& motion : unseen) result.degenerateMotions.emplace_back(toVehicle * motion);
  }
  if (!acoustic.empty()) useSeabed(acoustic, path, unseen, result);
  const core::Trajectory corrected = correctedPath(path, filter_.state().T_odom_imu());
  for (std::size_t i = 1; i < corrected.size(); ++i) {
    result.path.push_back(corrected.poses()[i]);
    recent_.append(corrected.poses()[i].time, corrected.poses()[i].T);
  }
  recent_.forgetBefore(scan.endTime() - core::durationNs(kRecent_s));
  insert(points);
  const Vector3d rate = steps.empty() ? Vector3d(Vector3d::Zero()) : steps.back().angularRate_radps;
  describe(points, rate, result);
  return result;
}

void ScanTracker::useHeavePrior(double sinceLast_s) {
  const WaterOptions& water = options_.water;
  filter_.loosenFloatingHeight(water.levelWalk_m_rts * water.levelWalk_m_rts * sinceLast_s);
  // One heave lasts over several scans, which together must not count for more than one measurement.
  const double share = std::min(1.0, sinceLast_s / (2 * water.heaveTime_s));
  const double sigma_m = std::clamp(kHeaveMargin * std::sqrt(heaveVariance_m2_), kLeastHeaveShare * water.heaveSigma_m,
                                    water.heaveSigma_m);
  const double heave_m = filter_.heightAboveFloating(T_imu_vehicle_);
  heaveVariance_m2_ += (heave_m * heave_m - heaveVariance_m2_) * std::min(1.0, sinceLast_s / kHeaveMemory_s);
  // An IMU tells leaning better.
  if (!filter_.hasImu()) filter_.measureLean(T_imu_vehicle_, water.leanSigma_rad / std::sqrt(share));
  const double misfit = filter_.measureHeave(T_imu_vehicle_, 0.0, sigma_m / std::sqrt(share));
  // Off for long by more than the heaves explain: the water itself has moved, so its level is unknown again.
  const double limit = water.giveUpSigma * std::sqrt(share);
  heaveMisfit_ += (misfit - heaveMisfit_) * share / kMisfitHeaves;
  if (std::abs(heaveMisfit_) > limit) {
    filter_.loosenFloatingHeight(kLostLevel_m * kLostLevel_m);
    heaveMisfit_ = 0;
  }
}

void ScanTracker::useVelocityPrior(double sinceLast_s, const Vector3d& angularRate_radps) {
  const WaterOptions& water = options_.water;
  // One speed lasts over many scans, which together must not count for more than one measurement.
  const double share = std::min(1.0, sinceLast_s / (2 * water.speedTime_s));
  const Vector3d sigma(water.speedSigma_mps, water.driftSigma_mps, std::numeric_limits<double>::infinity());
  filter_.measureVelocity(T_imu_vehicle_, angularRate_radps - filter_.state().gyroBias, Vector3d::Zero(),
                          sigma / std::sqrt(share));
}

ScanTracker::Points ScanTracker::thin(const Scan& scan) const {
  Points points;
  const auto kept = onePerCube(scan.points_sensor, options_.registration.mapVoxel_m);
  points.sensor.reserve(kept.size());
  points.offset_s.reserve(kept.size());
  const auto end_s = static_cast<float>(scan.duration_s);
  for (const auto i : kept) {
    points.sensor.push_back(scan.points_sensor[i]);
    points.offset_s.push_back(scan.offset_s.empty() ? end_s : scan.offset_s[i]);
  }
  return points;
}

void ScanTracker::deskew(const Scan& scan, const core::Trajectory& path, Points& points) const {
  const DeskewTable table(path, path.back().T.inverse(), scan.T_vehicle_sensor, scan.time, scan.endTime());
  points.vehicle.resize(points.sensor.size());
  for (std::size_t i = 0; i < points.sensor.size(); ++i)
    points.vehicle[i] = table.apply(points.sensor[i], points.offset_s[i]);
}

void ScanTracker::rejectBelowWater(Points& points, OdometryResult& result) const {
  if (options_.water.rejectBelow && filter_.hasImu()) {
    // The vehicle's origin rides on the water, so only its attitude tells the surface's place in its frame.
    const Vector3d up_odom = -filter_.state().gravity.normalized();
    const Eigen::Vector3f up_vehicle = (T_odom_vehicle().linear().transpose() * up_odom).cast<float>();
    const auto lowest = static_cast<float>(options_.water.height_m + options_.water.margin_m);
    // Far away the height is only as good as the attitude: a low shore must not be taken for water.
    const Eigen::Matrix3d doubt =
        T_vehicle_imu_.linear() * filter_.upCovariance() * T_vehicle_imu_.linear().transpose();
    const auto tilt_rad = static_cast<float>(std::min(kMostTiltDoubt_rad, kTiltDoubt * std::sqrt(doubt.trace() / 2)));
    std::size_t kept = 0;
    for (std::size_t i = 0; i < points.vehicle.size(); ++i) {
      if (up_vehicle.dot(points.vehicle[i]) < lowest - tilt_rad * points.vehicle[i].norm()) continue;
      points.sensor[kept] = points.sensor[i];
      points.offset_s[kept] = points.offset_s[i];
      points.vehicle[kept] = points.vehicle[i];
      ++kept;
    }
    result.belowWaterCount = points.vehicle.size() - kept;
    points.sensor.resize(kept);
    points.offset_s.resize(kept);
    points.vehicle.resize(kept);
  }
  points.registered = onePerCube(points.vehicle, options_.registration.scanVoxel_m);
}

BodyPoints ScanTracker::bodyPoints(const Points& points) const {
  BodyPoints body;
  body.points_body.reserve(points.registered.size());
  body.variance_m2.reserve(points.registered.size());
  for (const auto i : points.registered) {
    body.points_body.emplace_back(T_imu_vehicle_ * points.vehicle[i].cast<double>());
    body.variance_m2.push_back(pointVariance(points.sensor[i].norm(), options_.registration));
  }
  return body;
}

core::Trajectory ScanTracker::correctedPath(const std::vector<NavState>& path, const Isometry& T_odom_imu_end) const {
  // What the registration found was off grows evenly from the last scan's end, which is settled, to this one's.
  const Isometry correction = path.back().T_odom_imu().inverse() * T_odom_imu_end;
  const double total_s = core::secondsBetween(path.front().time, path.back().time);
  std::vector<core::TimedPose> poses = recent_.poses();
  for (std::size_t i = 1; i < path.size(); ++i) {
    const double u = core::secondsBetween(path.front().time, path[i].time) / total_s;
    const Isometry T = path[i].T_odom_imu() * core::interpolate(Isometry::Identity(), correction, u);
    poses.push_back({path[i].time, T * T_imu_vehicle_});
  }
  return core::Trajectory(std::move(poses));
}

RegistrationResult ScanTracker::registerScan(const Scan& scan, const std::vector<NavState>& path,
                                             Points& points) const {
  const PoseBelief prior{filter_.state().T_odom_imu(), filter_.poseCovariance()};
  RegistrationResult fit = registerPoints(bodyPoints(points), map_, prior, prior.T_map_body, options_.registration);
  if (fit.end == RegistrationEnd::tooFewMatches) return fit;
  const Isometry correction = prior.T_map_body.inverse() * fit.pose.T_map_body;
  const double moved_m = correction.translation().norm() + kRedeskewRange_m * core::logSo3(correction.linear()).norm();
  const int iterations = fit.iterations;
  if (!scan.offset_s.empty() && moved_m > kRedeskew_m) {
    deskew(scan, correctedPath(path, fit.pose.T_map_body), points);
    fit = registerPoints(bodyPoints(points), map_, prior, fit.pose.T_map_body, options_.registration);
    fit.iterations += iterations;
  }
  return fit;
}

BodyPoints ScanTracker::seabedPoints(const std::vector<AcousticScan>& acoustic, const core::Trajectory& path) const {
  std::vector<Eigen::Vector3f> points_vehicle;
  std::vector<float> sigma_m;
  const Isometry T_end_odom = path.back().T.inverse();
  for (const auto& scan : acoustic) {
    const auto T_odom_then = path.at(scan.time);
    if (!T_odom_then) continue;
    const Eigen::Isometry3f T_end_then = (T_end_odom * *T_odom_then).cast<float>();
    for (const auto& p : scan.points_vehicle) points_vehicle.emplace_back(T_end_then * p);
    sigma_m.insert(sigma_m.end(), scan.sigma_m.begin(), scan.sigma_m.end());
  }
  BodyPoints body;
  for (const auto i : onePerCube(points_vehicle, options_.seabed.pointVoxel_m)) {
    body.points_body.emplace_back(T_imu_vehicle_ * points_vehicle[i].cast<double>());
    const double sigma = std::max<double>(sigma_m[i], options_.seabed.leastSigma_m);
    body.variance_m2.push_back(sigma * sigma);
  }
  return body;
}

void ScanTracker::useSeabed(const std::vector<AcousticScan>& acoustic, const std::vector<NavState>& path,
                            const std::vector<core::Vector6>& unseen, OdometryResult& result) {
  const PoseBelief prior{filter_.state().T_odom_imu(), filter_.poseCovariance()};
  const BodyPoints points = seabedPoints(acoustic, correctedPath(path, prior.T_map_body));
  RegistrationOptions options = options_.registration;
  options.minMatches = options_.seabed.minMatches;
  options.correlation = options_.seabed.correlation;
  const RegistrationResult fit = registerPoints(points, seabed_, prior, prior.T_map_body, options, unseen);
  if (fit.end != RegistrationEnd::tooFewMatches) {
    filter_.setPosePosterior(fit.pose.T_map_body, fit.pose.covariance);
    result.seabedMatchCount = fit.matches;
    if (result.status == OdometryStatus::deadReckoned) {
      result.status = fit.degenerateMotions.empty() ? OdometryStatus::registered : OdometryStatus::degenerate;
      result.reason = fit.degenerateMotions.empty() ? OdometryReason::none : OdometryReason::weakGeometry;
    }
  }
  const Isometry T_odom_imu = filter_.state().T_odom_imu();
  std::vector<Vector3d> inOdom;
  inOdom.reserve(points.points_body.size());
  for (const auto& p : points.points_body) inOdom.emplace_back(T_odom_imu * p);
  seabed_.insert(inOdom);
}

void ScanTracker::insert(const Points& points) {
  const Isometry T = T_odom_vehicle();
  std::vector<Vector3d> inOdom;
  inOdom.reserve(points.vehicle.size());
  for (const auto& p : points.vehicle) inOdom.emplace_back(T * p.cast<double>());
  map_.insert(inOdom);
  if ((T.translation() - mapCentre_).norm() > 0.1 * options_.map.radius_m) {
    mapCentre_ = T.translation();
    map_.forgetBeyond(mapCentre_, options_.map.radius_m);
    seabed_.forgetBeyond(mapCentre_, options_.seabed.map.radius_m);
  }
}

Matrix6 ScanTracker::vehicleByImuError() const {
  Matrix6 toBody = Matrix6::Identity();
  toBody.topLeftCorner<3, 3>() = filter_.state().R_odom_imu.transpose();
  return adjoint(T_vehicle_imu_) * toBody;
}

void ScanTracker::describe(const Points& points, const Vector3d& angularRate_radps, OdometryResult& result) {
  const NavState& state = filter_.state();
  result.T_odom_vehicle = T_odom_vehicle();
  result.hasGravity = filter_.knowsUp();
  if (result.hasGravity) {
    result.up_odom = -state.gravity.normalized();
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - result.up_odom * result.up_odom.transpose();
    const Eigen::Matrix3d cov = filter_.covariance().block<3, 3>(kGravity, kGravity);
    result.gravitySigma_rad = std::sqrt((across * cov * across).trace() / 2.0) / state.gravity.norm();
  }
  if (filter_.hasImu()) {
    result.gyroBias_radps = state.gyroBias;
    result.accelBias_mps2 = state.accelBias;
    result.imu.timeOffset_s = state.timeOffset_s;
    result.imu.timeOffsetSigma_s = std::sqrt(filter_.covariance()(kTimeOffset, kTimeOffset));
    result.imu.turn_rad = core::logSo3(state.R_imu_readings);
    result.imu.turnSigma_rad = filter_.covariance().diagonal().segment<3>(kMounting).cwiseSqrt();
  }
  const Vector3d rate = state.R_imu_readings * angularRate_radps - state.gyroBias;
  result.velocity_odom = state.velocity + state.R_odom_imu * rate.cross(T_imu_vehicle_.translation());

  const Matrix6 A = vehicleByImuError();
  result.covariance_registration = A * filter_.poseCovariance() * A.transpose();
  // The first scan makes the map. Its points were measured half a sweep earlier on average, so they are off by half of
  // what the motion up to its end may be off by.
  if (result.status == OdometryStatus::firstScan) result.covariance_registration *= 0.25;
  accountDrift(points, result);
  result.points_vehicle.reserve(points.registered.size());
  for (const auto i : points.registered) result.points_vehicle.push_back(points.vehicle[i]);
}

void ScanTracker::accountDrift(const Points& points, OdometryResult& result) {
  // While the vehicle travels as far as it sees, the map is replaced by one built on poses that were off by the
  // registration's error; that error does not average out, because the same surfaces cause it all the way.
  double view_m = 0;
  for (const auto i : points.registered) view_m += points.vehicle[i].norm();
  view_m = std::max(1.0, view_m / static_cast<double>(std::max<std::size_t>(1, points.registered.size())));
  const Isometry T_last_now = T_odom_vehicle_last_.inverse() * result.T_odom_vehicle;
  const double share = std::min(1.0, T_last_now.translation().norm() / view_m);
  result.covariance_motion = share * result.covariance_registration;
  const Matrix6 A = adjoint(T_last_now.inverse());
  drift_ = A * drift_ * A.transpose() + result.covariance_motion;
  result.covariance_pose = drift_ + result.covariance_registration;
  T_odom_vehicle_last_ = result.T_odom_vehicle;
}

}  // namespace s2s::odometry
