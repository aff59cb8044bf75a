#include "replay.h"

namespace s2s::odometry::synthetic {

Replay replay(const Record& record) {
  Random random(record.seed);
  LidarInertialOdometry odometry(record.options);
  Replay out;
  const auto drain = [&] {
    while (auto result = odometry.next()) out.results.push_back(std::move(*result));
  };
  int imuCount = 0;
  for (int i = 0; record.lidar.period_s * i < record.duration_s; ++i) {
    const double t = record.lidar.period_s * i;
    for (; record.hasImu && 0.01 * imuCount < t; ++imuCount) {
      ImuSample sample = imuAt(record.path, 0.01 * imuCount, record.T_vehicle_imu, record.noise, random);
      if (!record.tamperImu || record.tamperImu(sample)) odometry.addImu(sample);
    }
    Scan scan = scanAt(record.world, record.path, t, record.lidar, random);
    if (!record.hasPointTimes) scan.offset_s.clear();
    if (!record.tamperScan || record.tamperScan(scan)) odometry.addScan(std::move(scan));
    // A record in the middle of each sweep, as it comes between its first point and its end.
    if (record.seabed)
      odometry.addAcoustic(acousticAt(record.seabed, record.path, t + 0.5 * record.lidar.period_s, 0.04, random));
    drain();
  }
  odometry.finish();
  drain();
  out.trajectory = odometry.trajectory();
  out.faults = odometry.faults();
  out.usedImu = odometry.usesImu();
  return out;
}

core::Isometry errorAt(const Replay& replay, const Record& record, std::size_t i) {
  const auto truth = [&](const OdometryResult& result) {
    return record.path(core::secondsBetween(timeOf(0), result.time));
  };
  std::size_t first = 0;
  while (replay.results[first].status == OdometryStatus::skipped) ++first;
  const auto& from = replay.results[first];
  const auto& to = replay.results[i];
  const core::Isometry ours = from.T_odom_vehicle.inverse() * to.T_odom_vehicle;
  return (truth(from).inverse() * truth(to)).inverse() * ours;
}

Worst worstError(const Replay& replay, const Record& record) {
  Worst worst;
  for (std::size_t i = 0; i < replay.results.size(); ++i) {
    if (replay.results[i].status == OdometryStatus::skipped) continue;
    const auto error = errorAt(replay, record, i);
    worst.translation_m = std::max(worst.translation_m, error.translation().norm());
    worst.rotation_rad = std::max(worst.rotation_rad, core::logSo3(error.linear()).norm());
  }
  return worst;
}

}  // namespace s2s::odometry::synthetic
