#include "s2s/odometry/deskew.h"

#include <mrpt/maps/CPointsMapXYZI.h>

#include "s2s/obs/sweep_projector.h"
#include "s2s/odometry/point_filter.h"

namespace s2s::odometry {

namespace {

constexpr double kTableStep_s = 1e-3;

core::Isometry poseNear(const core::Trajectory& trajectory, core::TimeNs time) {
  if (time <= trajectory.front().time) return trajectory.front().T;
  if (time >= trajectory.back().time) return trajectory.back().T;
  return *trajectory.at(time);
}

/// Adds one point to a cloud, unless it is below the lowest height.
class CloudFiller {
 public:
  CloudFiller(const DeskewOptions& options, const core::Isometry& T_frame_vehicle, DeskewedCloud& cloud)
      : options_(options),
        hasLowest_(std::isfinite(options.lowestHeight_m)),
        up_vehicle_((T_frame_vehicle.linear().transpose() * options.up).cast<float>()),
        height_(static_cast<float>(options.up.dot(T_frame_vehicle.translation()) - options.lowestHeight_m)),
        cloud_(cloud) {}

  void add(const Eigen::Vector3f& p_vehicle, float range_m, float reflectivity) {
    if (hasLowest_ && up_vehicle_.dot(p_vehicle) + height_ < 0) {
      ++cloud_.belowWaterCount;
      return;
    }
    cloud_.points_vehicle.push_back(p_vehicle);
    cloud_.reflectivity.push_back(reflectivity);
    cloud_.sigma_m.push_back(
        static_cast<float>(std::hypot(options_.rangeSigma_m, options_.angleSigma_rad * static_cast<double>(range_m))));
  }

 private:
  const DeskewOptions& options_;
  bool hasLowest_;
  Eigen::Vector3f up_vehicle_;
  float height_;
  DeskewedCloud& cloud_;
};

void count(PointFilter::Verdict verdict, DeskewedCloud& cloud) {
  if (verdict == PointFilter::Verdict::ownHull) ++cloud.ownHullCount;
  if (verdict == PointFilter::Verdict::outOfRange) ++cloud.outOfRangeCount;
}

/// Earliest and latest pixel time of a sweep.
std::pair<core::TimeNs, core::TimeNs> timeSpan(const obs::CObservationLidarSweep& sweep) {
  const core::TimeNs start = core::fromMrptTime(sweep.timestamp);
  const auto limits = [](const std::vector<std::int32_t>& times) {
    if (times.empty()) return std::pair<core::TimeNs, core::TimeNs>{0, 0};
    const auto [least, greatest] = std::minmax_element(times.begin(), times.end());
    return std::pair<core::TimeNs, core::TimeNs>{*least, *greatest};
  };
  const auto columns = limits(sweep.columnTime_ns), rows = limits(sweep.rowTime_ns);
  return {start + columns.first + rows.first, start + columns.second + rows.second};
}

}  // namespace

DeskewTable::DeskewTable(const core::Trajectory& trajectory, const core::Isometry& T_reference_frame,
                         const core::Isometry& T_vehicle_sensor, core::TimeNs first, core::TimeNs last) {
  const double duration_s = std::max(0.0, core::secondsBetween(first, last));
  const auto rows = static_cast<std::size_t>(std::ceil(duration_s / kTableStep_s)) + 1;
  rowsPerSecond_ = duration_s > 0 ? static_cast<float>((rows - 1) / duration_s) : 0.0F;
  lastRow_ = static_cast<float>(rows - 1);
  R_.reserve(rows + 1);
  t_.reserve(rows + 1);
  for (std::size_t row = 0; row < rows + 1; ++row) {  // one more, so that the last row has a neighbour
    const double u = rows > 1 ? static_cast<double>(std::min(row, rows - 1)) / static_cast<double>(rows - 1) : 0.0;
    const core::Isometry T =
        T_reference_frame * poseNear(trajectory, first + core::durationNs(u * duration_s)) * T_vehicle_sensor;
    R_.push_back(T.linear().cast<float>());
    t_.push_back(T.translation().cast<float>());
  }
}

DeskewedCloud deskewSweep(const obs::CObservationLidarSweep& sweep, const core::Trajectory& T_odom_vehicle,
                          core::TimeNs reference, const DeskewOptions& options) {
  sweep.checkConsistent();
  DeskewedCloud cloud;
  cloud.time = reference;
  const auto T_odom_reference = T_odom_vehicle.at(reference);
  if (!T_odom_reference || sweep.echoes.empty()) return cloud;

  obs::SweepProjector projector;
  projector.prepare(sweep);
  const core::Isometry T_vehicle_sensor = core::toIsometry(sweep.sensorPose);
  const PointFilter filter(options.filter, T_vehicle_sensor);
  const auto [first, last] = timeSpan(sweep);
  const DeskewTable table(T_odom_vehicle, T_odom_reference->inverse(), T_vehicle_sensor, first, last);
  CloudFiller filler(options, *T_odom_reference, cloud);
  const auto& echo = sweep.echoes.front();
  const core::TimeNs start = core::fromMrptTime(sweep.timestamp);
  const std::size_t returns = sweep.returnCount();
  cloud.points_vehicle.reserve(returns);
  cloud.reflectivity.reserve(returns);
  cloud.sigma_m.reserve(returns);
  for (std::size_t row = 0; row < sweep.rowCount; ++row)
    for (std::size_t column = 0; column < sweep.columnCount; ++column) {
      const std::size_t pixel = row * sweep.columnCount + column;
      if (echo.range[pixel] == 0 || !sweep.isColumnValid(column)) continue;
      const core::TimeNs time = start + sweep.pixelTime_ns(row, column);
      if (time < T_odom_vehicle.front().time || time > T_odom_vehicle.back().time) {
        ++cloud.withoutPoseCount;
        continue;
      }
      const Eigen::Vector3f p_sensor = projector.point(row, column, echo.range[pixel]);
      const auto verdict = filter.judge(p_sensor);
      count(verdict, cloud);
      if (verdict != PointFilter::Verdict::keep) continue;
      const float reflectivity = echo.reflectivity.empty() ? 0.0F : static_cast<float>(echo.reflectivity[pixel]);
      filler.add(table.apply(p_sensor, 1e-9F * static_cast<float>(time - first)), p_sensor.norm(), reflectivity);
    }
  return cloud;
}

DeskewedCloud deskewCloud(const mrpt::obs::CObservationPointCloud& observation, const core::Trajectory& T_odom_vehicle,
                          core::TimeNs reference, const DeskewOptions& options) {
  DeskewedCloud cloud;
  cloud.time = reference;
  const auto T_odom_reference = T_odom_vehicle.at(reference);
  if (!T_odom_reference || !observation.pointcloud) return cloud;
  const auto& points = *observation.pointcloud;
  const auto T_odom_vehicle_then = T_odom_vehicle.at(core::fromMrptTime(observation.timestamp));
  if (!T_odom_vehicle_then) {
    cloud.withoutPoseCount = points.size();
    return cloud;
  }
  const core::Isometry T_vehicle_sensor = core::toIsometry(observation.sensorPose);
  const Eigen::Isometry3f T_reference_sensor =
      (T_odom_reference->inverse() * *T_odom_vehicle_then * T_vehicle_sensor).cast<float>();
  const PointFilter filter(options.filter, T_vehicle_sensor);
  CloudFiller filler(options, *T_odom_reference, cloud);
  const auto* withIntensity = dynamic_cast<const mrpt::maps::CPointsMapXYZI*>(&points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    Eigen::Vector3f p_sensor;
    points.getPointFast(i, p_sensor.x(), p_sensor.y(), p_sensor.z());
    const auto verdict = filter.judge(p_sensor);
    count(verdict, cloud);
    if (verdict != PointFilter::Verdict::keep) continue;
    const float reflectivity = withIntensity ? withIntensity->getPointIntensity(i) : 0.0F;
    filler.add(T_reference_sensor * p_sensor, p_sensor.norm(), reflectivity);
  }
  return cloud;
}

}  // namespace s2s::odometry
