// CSeabedSkyMap as MRPT's programs fill it: one observation at one robot pose, each a keyframe of its own.

#include <mrpt/core/Clock.h>

#include "observation_points.h"
#include "s2s/map/CSeabedSkyMap.h"

namespace s2s::map {

bool CSeabedSkyMap::internal_insertObservation(const mrpt::obs::CObservation& observation,
                                               const std::optional<const mrpt::poses::CPose3D>& robotPose) {
  const auto points = pointsOf(observation, options_.insertion);
  if (!points || points->empty()) return false;
  const ScanPose pose = addOwnKeyframe(observation, robotPose, Layer::Lidar);
  return store(pose, *points) != 0;
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
