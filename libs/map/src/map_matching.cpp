// Matching and likelihood of CSeabedSkyMap: all ask the thinned LiDAR layer for its nearest point.

#include <algorithm>
#include <cmath>

#include "nearest_cache.h"
#include "observation_points.h"
#include "s2s/map/CSeabedSkyMap.h"

namespace s2s::map {

namespace {

/// MRPT's matching wants a point map on the other side; of one of ours it takes the LiDAR layer.
const mrpt::maps::CMetricMap* asPoints(const mrpt::maps::CMetricMap* map) {
  if (const auto* ours = dynamic_cast<const CSeabedSkyMap*>(map)) return ours->getAsSimplePointsMap();
  return map;
}

}  // namespace

std::shared_ptr<NearestCache> makeNearestCache() { return std::make_shared<NearestCache>(); }

const mrpt::maps::CSimplePointsMap& CSeabedSkyMap::nearestMap() const {
  std::call_once(nearest_->made, [this] {
    VoxelThinner thinner;
    forEachPoint(Layer::Lidar, [&](const MapPoint& point) {
      // One time for all: each voxel takes one point only.
      if (!thinner.accept(point.p_map, 0, options_.likelihood.mapVoxel_m, 0)) return;
      const Eigen::Vector3f p = point.p_map.cast<float>();
      nearest_->map.insertPointFast(p.x(), p.y(), p.z());
    });
    nearest_->map.mark_as_modified();
    if (!nearest_->map.empty()) nearest_->map.kdTreeEnsureIndexBuilt3D();
  });
  return nearest_->map;
}

const mrpt::maps::CSimplePointsMap* CSeabedSkyMap::getAsSimplePointsMap() const { return &nearestMap(); }

void CSeabedSkyMap::determineMatching2D(const mrpt::maps::CMetricMap* otherMap,
                                        const mrpt::poses::CPose2D& otherMapPose,
                                        mrpt::tfest::TMatchingPairList& correspondences,
                                        const mrpt::maps::TMatchingParams& params,
                                        mrpt::maps::TMatchingExtraResults& extraResults) const {
  nearestMap().determineMatching2D(asPoints(otherMap), otherMapPose, correspondences, params, extraResults);
}

void CSeabedSkyMap::determineMatching3D(const mrpt::maps::CMetricMap* otherMap,
                                        const mrpt::poses::CPose3D& otherMapPose,
                                        mrpt::tfest::TMatchingPairList& correspondences,
                                        const mrpt::maps::TMatchingParams& params,
                                        mrpt::maps::TMatchingExtraResults& extraResults) const {
  nearestMap().determineMatching3D(asPoints(otherMap), otherMapPose, correspondences, params, extraResults);
}

float CSeabedSkyMap::compute3DMatchingRatio(const mrpt::maps::CMetricMap* otherMap,
                                            const mrpt::poses::CPose3D& otherMapPose,
                                            const mrpt::maps::TMatchingRatioParams& params) const {
  return nearestMap().compute3DMatchingRatio(asPoints(otherMap), otherMapPose, params);
}

float CSeabedSkyMap::squareDistanceToClosestCorrespondence(float x0, float y0) const {
  return nearestMap().squareDistanceToClosestCorrespondence(x0, y0);
}

bool CSeabedSkyMap::internal_canComputeObservationLikelihood(const mrpt::obs::CObservation& observation) const {
  return pointCount(Layer::Lidar) != 0 && carriesPoints(observation);
}

double CSeabedSkyMap::internal_computeObservationLikelihood(const mrpt::obs::CObservation& observation,
                                                            const mrpt::poses::CPose3D& takenFrom) const {
  const mrpt::maps::CSimplePointsMap& map = nearestMap();
  if (map.empty()) return 0;
  const auto points = pointsOf(observation, options_.insertion);
  if (!points || points->empty()) return 0;
  const LikelihoodOptions& options = options_.likelihood;
  const core::Isometry T_map_vehicle = core::toIsometry(takenFrom);
  const double limit2 = options.maxDistance_m * options.maxDistance_m;
  const auto step = static_cast<std::size_t>(std::max(1, options.decimation));
  double sum2 = 0;
  for (std::size_t i = 0; i < points->size(); i += step) {
    const Eigen::Vector3f p = (T_map_vehicle * (*points)[i].p_vehicle.cast<double>()).cast<float>();
    float distance2 = 0;
    map.kdTreeClosestPoint3D(p.x(), p.y(), p.z(), distance2);
    sum2 += std::min(limit2, static_cast<double>(distance2));
  }
  return -0.5 * sum2 / (options.sigma_m * options.sigma_m);
}

}  // namespace s2s::map
