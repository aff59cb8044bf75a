// CSeabedSkyMap as MRPT's programs fill it: one observation at one robot pose, each a keyframe of its own.

#include <mrpt/core/Clock.h>

#include "observation_points.h"
#include "ping_pairer.h"
#include "s2s/core/error.h"
#include "s2s/map/CSeabedSkyMap.h"
#include "s2s/map/sonar_scans.h"

namespace s2s::map {

bool CSeabedSkyMap::internal_insertObservation(const mrpt::obs::CObservation& observation,
                                               const std::optional<const mrpt::poses::CPose3D>& robotPose) {
  if (const auto* ping = dynamic_cast<const obs::CObservationImagingSonar*>(&observation))
    return insertPing(*ping, robotPose);
  const auto points = pointsOf(observation, options_.insertion);
  if (!points || points->empty()) return false;
  return store(addOwnKeyframe(observation, robotPose, Layer::Lidar), *points) != 0;
}

bool CSeabedSkyMap::insertPing(const obs::CObservationImagingSonar& ping,
                               const std::optional<const mrpt::poses::CPose3D>& robotPose) {
  if (!pairer_) pairer_ = std::make_shared<PingPairer>();
  PlacedPing placed;
  placed.T_vehicle_sonar = core::toIsometry(ping.sensorPose);
  const bool isVertical = isVerticalSonar(placed.T_vehicle_sonar);
  try {
    ping.checkConsistent();
    placed.processed = pairer_->device(isVertical).process(ping);
  } catch (const core::InputError&) {
    return false;  // a damaged ping is no reason to stop: MRPT counts what was not inserted
  }
  placed.pose = addOwnKeyframe(ping, robotPose, isVertical ? Layer::LineVertical : Layer::LineHorizontal);
  placed.T_map_vehicle = mapPose(placed.pose);
  const auto stereo = pairer_->add(placed, isVertical, options_.insertion.stereoWindow_s);
  // Stereo points first: they are evidence for the elevations of the leading edge.
  if (stereo) store(stereo->pose, stereo->points);
  const std::size_t kept = store(placed.pose, toMapLineScan(placed.processed.lineScan, placed.T_vehicle_sonar));
  return kept != 0 || stereo.has_value();
}

ScanPose CSeabedSkyMap::addOwnKeyframe(const mrpt::obs::CObservation& observation,
                                       const std::optional<const mrpt::poses::CPose3D>& robotPose, Layer layer) {
  Keyframe keyframe;
  // MRPT inserts in any order and at any time, so ids go on from the number there is.
  keyframe.id = keyframes_.all().size();
  while (keyframes_.find(keyframe.id)) ++keyframe.id;
  if (observation.timestamp != INVALID_TIMESTAMP) keyframe.time = core::fromMrptTime(observation.timestamp);
  if (robotPose) keyframe.T_odom_vehicle = core::toIsometry(*robotPose);
  keyframe.T_map_vehicle = keyframe.T_odom_vehicle;
  keyframes_.add(keyframe);
  return {layer, keyframe.time, keyframe.T_odom_vehicle, keyframe.id};
}

}  // namespace s2s::map
