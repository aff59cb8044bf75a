#include "mrpt_icp_odometry.h"

#include <mrpt/slam/CICP.h>

#include "s2s/odometry/deskew.h"
#include "s2s/odometry/downsample.h"

namespace s2s::bench {

namespace {

using core::Isometry;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kMapCube_m = 0.3;     // one point each
constexpr double kMapRadius_m = 60.0;  // points further away are forgotten
constexpr double kForgetEvery_m = 10.0;
/// What a pose from the ICP is believed to.
constexpr double kIcpSigma_m = 0.03, kIcpSigma_rad = 2e-3;

std::uint64_t cubeOf(const Vector3d& p) {
  const auto part = [](double x) { return static_cast<std::uint64_t>(std::llround(x / kMapCube_m) + (1 << 20)); };
  return part(p.x()) | part(p.y()) << 21 | part(p.z()) << 42;
}

}  // namespace

MrptIcpOdometry::MrptIcpOdometry(std::string name, const odometry::OdometryOptions& options)
    : Contestant(std::move(name)),
      options_(options),
      maker_(options.scan),
      starter_(std::make_unique<odometry::LidarInertialOdometry>(options)) {}

void MrptIcpOdometry::takeImu(const odometry::ImuSample& sample) {
  imu_.add(sample);
  T_vehicle_imu_ = sample.T_vehicle_imu;
  if (starter_) starter_->addImu(sample);
  drain();
}

void MrptIcpOdometry::takeSweep(const obs::CObservationLidarSweep& sweep) {
  waiting_.push_back(maker_.fromSweep(sweep));
  if (starter_) starter_->addScan(waiting_.back());
  drain();
}

void MrptIcpOdometry::takeEnd() {
  if (starter_) starter_->finish();
  drain();
  for (; filter_ && !waiting_.empty(); waiting_.pop_front()) process(waiting_.front());
}

void MrptIcpOdometry::tryStart() {
  const auto first = starter_->next();
  if (!first) return;
  odometry::NavState state;
  state.time = first->scanTime;
  const Isometry T_odom_imu = starter_->trajectory().front().T * T_vehicle_imu_;
  state.position = T_odom_imu.translation();
  state.R_odom_imu = T_odom_imu.linear();
  state.velocity = first->velocity_odom;
  state.gyroBias = first->gyroBias_radps;
  state.accelBias = first->accelBias_mps2;
  state.gravity = -options_.imu.gravity_mps2 * first->up_odom;
  odometry::ErrorMatrix covariance = odometry::ErrorMatrix::Zero();
  const auto set = [&](int at, double sigma) { covariance.diagonal().segment<3>(at).setConstant(sigma * sigma); };
  set(odometry::kPosition, 1e-4);
  set(odometry::kRotation, 1e-4);
  set(odometry::kVelocity, 0.05);
  set(odometry::kGyroBias, 1e-3);
  set(odometry::kAccelBias, options_.imu.accelBiasSigma_mps2);
  set(odometry::kGravity, 0.1);
  covariance(odometry::kFloating, odometry::kFloating) = 0.05 * 0.05;
  filter_.emplace(options_.imu, options_.motion, true);
  filter_->reset(state, covariance);
  starter_.reset();
}

void MrptIcpOdometry::drain() {
  if (starter_) tryStart();
  while (filter_ && !waiting_.empty() && imu_.lastTime() >= waiting_.front().endTime()) {
    process(waiting_.front());
    waiting_.pop_front();
  }
}

void MrptIcpOdometry::process(const odometry::Scan& scan) {
  if (scan.points_sensor.empty() || scan.endTime() <= filter_->state().time) return;
  const double sinceLast_s = core::secondsBetween(filter_->state().time, scan.endTime());
  std::vector<odometry::NavState> path{filter_->state()};
  filter_->propagate(imu_.steps(path.front().time, scan.endTime(), options_.imu.maxGap_s), &path);
  imu_.forgetBefore(scan.endTime());
  if (options_.water.heavePrior)
    filter_->measureHeave(T_vehicle_imu_.inverse(), 0,
                          options_.water.heaveSigma_m / std::sqrt(sinceLast_s / (2 * options_.water.heaveTime_s)));
  const auto points = pointsOf(scan, path);
  if (!map_.empty()) align(points);
  insert(points);
  odometry::OdometryResult result;
  result.status = odometry::OdometryStatus::registered;
  result.scanTime = scan.time;
  result.time = scan.endTime();
  result.T_odom_vehicle = T_odom_vehicle();
  keep(std::move(result));
}

std::vector<Vector3f> MrptIcpOdometry::pointsOf(const odometry::Scan& scan,
                                                const std::vector<odometry::NavState>& path) const {
  core::Trajectory poses;
  for (const auto& state : path) poses.append(state.time, state.T_odom_imu() * T_vehicle_imu_.inverse());
  const odometry::DeskewTable table(poses, poses.back().T.inverse(), scan.T_vehicle_sensor, scan.time, scan.endTime());
  const Vector3f up = (T_odom_vehicle().linear().transpose() * -filter_->state().gravity.normalized()).cast<float>();
  const auto lowest = static_cast<float>(options_.water.height_m + options_.water.margin_m);
  std::vector<Vector3f> points;
  for (const auto i : odometry::onePerCube(scan.points_sensor, options_.registration.scanVoxel_m)) {
    const float offset_s = scan.offset_s.empty() ? static_cast<float>(scan.duration_s) : scan.offset_s[i];
    const Vector3f p = table.apply(scan.points_sensor[i], offset_s);
    if (!options_.water.rejectBelow || up.dot(p) > lowest) points.push_back(p);
  }
  return points;
}

void MrptIcpOdometry::align(const std::vector<Vector3f>& points_vehicle) {
  mrpt::maps::CSimplePointsMap scan;
  for (const auto& p : points_vehicle) scan.insertPoint(p.x(), p.y(), p.z());
  mrpt::slam::CICP icp;
  icp.options.maxIterations = 50;
  icp.options.thresholdDist = 0.75;
  icp.options.smallestThresholdDist = 0.1;
  icp.options.corresponding_points_decimation = 1;
  icp.options.skip_cov_calculation = true;
  const auto found = icp.Align3D(&map_, &scan, core::toPose(T_odom_vehicle()));
  core::Matrix6 noise = core::Matrix6::Zero();
  noise.diagonal() << Vector3d::Constant(kIcpSigma_m * kIcpSigma_m), Vector3d::Constant(kIcpSigma_rad * kIcpSigma_rad);
  filter_->measurePose(core::toIsometry(found->getMeanVal()) * T_vehicle_imu_, noise);
}

void MrptIcpOdometry::insert(const std::vector<Vector3f>& points_vehicle) {
  const Isometry T = T_odom_vehicle();
  if ((T.translation() - mapCentre_).norm() > kForgetEvery_m) {
    mapCentre_ = T.translation();
    mrpt::maps::CSimplePointsMap near;
    taken_.clear();
    for (std::size_t i = 0; i < map_.size(); ++i) {
      float x = 0, y = 0, z = 0;
      map_.getPoint(i, x, y, z);
      const Vector3d p(x, y, z);
      if ((p - mapCentre_).norm() > kMapRadius_m) continue;
      near.insertPoint(x, y, z);
      taken_.insert(cubeOf(p));
    }
    map_ = near;
  }
  for (const auto& p_vehicle : points_vehicle) {
    const Vector3d p = T * p_vehicle.cast<double>();
    if (taken_.insert(cubeOf(p)).second)
      map_.insertPoint(static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()));
  }
}

}  // namespace s2s::bench
