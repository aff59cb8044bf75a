#include "s2s/mapper/backend_stage.h"

#include "s2s/map/sonar_scans.h"

namespace s2s::mapper {

BackendStage::BackendStage(const graph::GraphSlamOptions& graphOptions, const map::MapOptions& mapOptions,
                           std::unique_ptr<graph::PriorMap> prior)
    : graph_(graphOptions, std::move(prior)), submaps_(graphOptions.sonar, mapOptions.resolver), map_(mapOptions) {}

void BackendStage::addKeyframe(const KeyframeData& keyframe) {
  graph::KeyframeInput input;
  input.time = keyframe.time;
  input.T_odom_vehicle = keyframe.T_odom_vehicle;
  input.motionCovariance = keyframe.motionCovariance;
  input.cloud_vehicle = keyframe.registrationPoints_vehicle;
  if (keyframe.hasGravity) input.gravity = graph::GravityMeasurement{keyframe.up_vehicle, keyframe.gravitySigma_rad};
  const auto update = graph_.addKeyframe(input);

  const auto& added = graph_.keyframes().at(static_cast<std::size_t>(update.id));
  map_.addKeyframe({keyframe.id, added.time, added.T_odom_vehicle, added.T_map_vehicle});
  map_.insertScan(map::Layer::Lidar, keyframe.time, keyframe.T_odom_vehicle, keyframe.points);
  if (update.optimised) moveMap();
}

void BackendStage::addSonarScan(const SonarScan& scan) {
  if (const auto submap = submaps_.add(scan)) graph_.addSubmap(*submap);
  if (scan.layer == map::Layer::Stereo)
    map_.insertScan(scan.layer, scan.time, scan.T_odom_vehicle, scan.points);
  else
    map_.insertLineScan(scan.layer, scan.time, scan.T_odom_vehicle,
                        map::toMapLineScan(scan.line, scan.T_vehicle_sonar));
}

void BackendStage::finish() {
  if (graph_.keyframes().empty()) return;
  if (const auto submap = submaps_.finish()) graph_.addSubmap(*submap);
  graph_.optimizeNow();
  moveMap();
  map_.resolveLineScans();
}

void BackendStage::moveMap() {
  std::map<std::uint64_t, core::Isometry> poses;
  for (const auto& keyframe : graph_.keyframes())
    poses[static_cast<std::uint64_t>(keyframe.id)] = keyframe.T_map_vehicle;
  map_.setKeyframePoses(poses);
}

}  // namespace s2s::mapper
