#include "s2s/odometry/scan_maker.h"

#include <mrpt/maps/CPointsMap.h>

#include "s2s/odometry/point_filter.h"

namespace s2s::odometry {

namespace {

struct Stride {
  std::size_t row = 1, column = 1;
};

/// The strides asked for, or the smallest that keep the count of returns, with about equal angles between rows and
/// columns. Over open water few beams come back, and each of them counts.
Stride strideFor(const obs::CObservationLidarSweep& sweep, const ScanOptions& options) {
  Stride stride{static_cast<std::size_t>(std::max(options.rowStride, 1)),
                static_cast<std::size_t>(std::max(options.columnStride, 1))};
  const auto [lowest, highest] = std::minmax_element(sweep.beamAltitude_rad.begin(), sweep.beamAltitude_rad.end());
  const double rowStep_rad = (*highest - *lowest) / std::max<double>(1, sweep.rowCount - 1.0);
  const double columnStep_rad = 2 * M_PI / sweep.columnCount;
  const auto& range = sweep.echoes.front().range;
  const auto returns = range.size() - static_cast<std::size_t>(std::count(range.begin(), range.end(), 0U));
  const auto tooMany = [&] {
    return returns > stride.row * stride.column * static_cast<std::size_t>(options.maxPoints);
  };
  while (tooMany()) {
    const bool widenColumns = options.rowStride > 0 || (columnStep_rad * stride.column <= rowStep_rad * stride.row) ||
                              stride.row >= sweep.rowCount;
    if (widenColumns && options.columnStride == 0 && stride.column < sweep.columnCount)
      ++stride.column;
    else if (options.rowStride == 0 && stride.row < sweep.rowCount)
      ++stride.row;
    else
      break;
  }
  return stride;
}

void keep(const PointFilter& filter, const Eigen::Vector3f& point, Scan& scan) {
  switch (filter.judge(point)) {
    case PointFilter::Verdict::keep:
      scan.points_sensor.push_back(point);
      break;
    case PointFilter::Verdict::ownHull:
      ++scan.ownHullCount;
      break;
    case PointFilter::Verdict::outOfRange:
      ++scan.outOfRangeCount;
      break;
  }
}

}  // namespace

Scan ScanMaker::fromSweep(const obs::CObservationLidarSweep& sweep) {
  sweep.checkConsistent();
  Scan scan;
  scan.time = core::fromMrptTime(sweep.timestamp);
  scan.duration_s = sweep.duration_s();
  scan.T_vehicle_sensor = core::toIsometry(sweep.sensorPose);
  if (sweep.echoes.empty() || sweep.pixelCount() == 0) return scan;

  projector_.prepare(sweep);
  const PointFilter filter(options_, scan.T_vehicle_sensor);
  const Stride stride = strideFor(sweep, options_);
  const auto& range = sweep.echoes.front().range;
  const bool hasTimes = !sweep.columnTime_ns.empty();
  // Steps of about 0.38 and 0.62 of the stride visit all rows and columns without a pattern.
  const std::size_t rowPhase = (scanCount_ * (1 + stride.row * 3 / 8)) % stride.row;
  const std::size_t columnPhase = (scanCount_ * (1 + stride.column * 5 / 8)) % stride.column;
  ++scanCount_;
  for (std::size_t row = rowPhase; row < sweep.rowCount; row += stride.row)
    for (std::size_t column = columnPhase; column < sweep.columnCount; column += stride.column) {
      const std::uint32_t counts = range[row * sweep.columnCount + column];
      if (counts == 0 || !sweep.isColumnValid(column)) continue;
      keep(filter, projector_.point(row, column, counts), scan);
      if (hasTimes && scan.offset_s.size() < scan.points_sensor.size())
        scan.offset_s.push_back(1e-9F * static_cast<float>(sweep.pixelTime_ns(row, column)));
    }
  return scan;
}

Scan ScanMaker::fromCloud(const mrpt::obs::CObservationPointCloud& cloud) {
  Scan scan;
  scan.time = core::fromMrptTime(cloud.timestamp);
  scan.T_vehicle_sensor = core::toIsometry(cloud.sensorPose);
  if (!cloud.pointcloud) return scan;
  const auto& x = cloud.pointcloud->getPointsBufferRef_x();
  const auto& y = cloud.pointcloud->getPointsBufferRef_y();
  const auto& z = cloud.pointcloud->getPointsBufferRef_z();
  const PointFilter filter(options_, scan.T_vehicle_sensor);
  // A cloud is not organised: without strides all its points are looked at, as the thinning by cubes is cheap enough.
  const std::size_t stride = std::max<std::size_t>(
      1, static_cast<std::size_t>(options_.rowStride) * static_cast<std::size_t>(std::max(options_.columnStride, 1)));
  for (std::size_t i = 0; i < x.size(); i += stride) keep(filter, {x[i], y[i], z[i]}, scan);
  return scan;
}

}  // namespace s2s::odometry
