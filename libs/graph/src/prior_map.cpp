#include "s2s/graph/prior_map.h"

#include "closure_verifier.h"

namespace s2s::graph {

PriorMap::PriorMap(std::vector<PriorKeyframe> keyframes, const ScanContextOptions& places,
                   const RegistrationOptions& registration, double submap_m)
    : keyframes_(std::move(keyframes)), places_(places), registration_(registration), submap_m_(submap_m) {
  for (const auto& keyframe : keyframes_) places_.add(keyframe.cloud_vehicle, levelRotation(keyframe.T_prior_vehicle));
}

std::vector<core::Isometry> PriorMap::placesLike(const Cloud& cloud_vehicle, const core::Isometry& T_level,
                                                 const RelocationOptions& options) const {
  std::vector<core::Isometry> poses;
  const Eigen::Matrix3d R_level_vehicle = levelRotation(T_level);
  for (const PlaceMatch& match :
       places_.findLike(cloud_vehicle, R_level_vehicle, options.shortlist, options.maxDistance, options.candidates)) {
    const core::Isometry& T_prior_place = keyframes_[static_cast<std::size_t>(match.place)].T_prior_vehicle;
    const Eigen::Vector3d x_prior = T_prior_place.linear().col(0);
    core::Isometry T = T_prior_place;
    T.linear() = Eigen::AngleAxisd(std::atan2(x_prior.y(), x_prior.x()) + match.yaw_rad, Eigen::Vector3d::UnitZ())
                     .toRotationMatrix() *
                 R_level_vehicle;
    poses.push_back(T);
  }
  return poses;
}

int PriorMap::nearest(const Eigen::Vector3d& p_prior) const {
  int best = -1;
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < keyframes_.size(); ++k) {
    const double squared = (keyframes_[k].T_prior_vehicle.translation() - p_prior).squaredNorm();
    if (squared >= smallest) continue;
    smallest = squared;
    best = static_cast<int>(k);
  }
  return best;
}

double PriorMap::distanceTo_m(const Eigen::Vector3d& p_prior) const {
  const int k = nearest(p_prior);
  return k < 0 ? std::numeric_limits<double>::infinity()
               : (keyframes_[static_cast<std::size_t>(k)].T_prior_vehicle.translation() - p_prior).norm();
}

const RegistrationTarget& PriorMap::submapAround(int keyframe) {
  const auto found = submaps_.find(keyframe);
  if (found != submaps_.end()) return *found->second;
  constexpr std::size_t kKept = 16;
  if (submaps_.size() >= kKept) submaps_.clear();
  // The old map is settled, so that keyframes of any pass belong to the submap.
  const core::Isometry T_keyframe_prior = keyframes_[static_cast<std::size_t>(keyframe)].T_prior_vehicle.inverse();
  Cloud points;
  for (const auto& other : keyframes_) {
    const core::Isometry T = T_keyframe_prior * other.T_prior_vehicle;
    if (T.translation().norm() <= submap_m_) appendTransformed(T, other.cloud_vehicle, points);
  }
  return *(submaps_[keyframe] = std::make_unique<RegistrationTarget>(points, registration_));
}

LoopClosure PriorMap::registerAt(const core::Isometry& T_prior_vehicle, const Cloud& cloud_vehicle) {
  const int keyframe = nearest(T_prior_vehicle.translation());
  LoopClosure closure;
  closure.status = ClosureStatus::rejectedOverlap;
  if (keyframe < 0) return closure;
  const core::Isometry& T_prior_keyframe = keyframes_[static_cast<std::size_t>(keyframe)].T_prior_vehicle;
  closure = closureFrom(registerCloud(submapAround(keyframe), cloud_vehicle,
                                      T_prior_keyframe.inverse() * T_prior_vehicle, registration_));
  closure.T_from_to = T_prior_keyframe * closure.T_from_to;
  return closure;
}

}  // namespace s2s::graph
