#include "loop_search.h"

#include <algorithm>

namespace s2s::graph {

namespace {

/// Standard deviation of the newest position relative to an old one, by the odometry alone.
double drift_m(const SurveyState& state, int old) {
  return std::sqrt(state.chain.covariance(old, state.chain.size() - 1).topLeftCorner<3, 3>().trace());
}

}  // namespace

void LoopSearch::add(const SurveyState& state) {
  places_.add(state.clouds_vehicle.back(), levelRotation(state.keyframes.back().T_map_vehicle));
}

bool LoopSearch::due(const SurveyState& state) {
  const int newest = state.chain.size() - 1;
  if (!options_.enabled) return false;
  if (lastSearched_ >= 0 && state.chain.travelled_m(lastSearched_, newest) < options_.searchEvery_m) return false;
  lastSearched_ = newest;
  return true;
}

/// Number of keyframes that lie at least minTravel_m back along the path.
int LoopSearch::olderKeyframes(const SurveyState& state) const {
  int count = state.chain.size();
  const int newest = count - 1;
  while (count > 0 && state.chain.travelled_m(count - 1, newest) < options_.minTravel_m) --count;
  return count;
}

std::vector<ClosureCandidate> LoopSearch::find(const SurveyState& state) const {
  std::vector<ClosureCandidate> candidates;
  const int count = olderKeyframes(state);
  findNear(state, count, candidates);
  findAlike(state, count, candidates);
  return candidates;
}

void LoopSearch::findNear(const SurveyState& state, int count, std::vector<ClosureCandidate>& candidates) const {
  const core::Isometry& newest = state.keyframes.back().T_map_vehicle;
  std::vector<std::pair<double, int>> near;
  for (int k = 0; k < count; ++k) {
    const double distance_m = (state.keyframes[k].T_map_vehicle.translation() - newest.translation()).norm();
    if (distance_m >= 2 * options_.radius_m) continue;  // most of a long survey, spared the costly drift
    if (distance_m < options_.radius_m + 2 * drift_m(state, k)) near.emplace_back(distance_m, k);
  }
  std::sort(near.begin(), near.end());
  for (const auto& [distance_m, k] : near) {
    if (static_cast<int>(candidates.size()) >= options_.proximityCandidates) return;
    // The next nearest keyframes are those beside the nearest; only another pass tells something new.
    const bool samePass = std::any_of(candidates.begin(), candidates.end(), [&, k = k](const auto& other) {
      return state.chain.travelled_m(other.keyframe, k) < options_.minTravel_m;
    });
    if (samePass) continue;
    candidates.push_back({k, state.keyframes[k].T_map_vehicle.inverse() * newest, ClosureSource::proximity});
  }
}

void LoopSearch::findAlike(const SurveyState& state, int count, std::vector<ClosureCandidate>& candidates) const {
  const int newest = state.chain.size() - 1;
  const core::Isometry& T_map_newest = state.keyframes.back().T_map_vehicle;
  for (const PlaceMatch& match : places_.find(newest, count, options_.descriptorCandidates)) {
    const core::Isometry& T_map_place = state.keyframes[match.place].T_map_vehicle;
    const bool known = std::any_of(candidates.begin(), candidates.end(), [&](const auto& other) {
      return state.chain.travelled_m(other.keyframe, match.place) < options_.submap_m;
    });
    const double distance_m = (T_map_place.translation() - T_map_newest.translation()).norm();
    if (known || distance_m > 2 * options_.radius_m + 4 * drift_m(state, match.place)) continue;
    ClosureCandidate candidate{match.place, core::Isometry::Identity(), ClosureSource::descriptor};
    candidate.T_candidate_newest.linear() =
        levelRotation(T_map_place).transpose() *
        Eigen::AngleAxisd(match.yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix() * levelRotation(T_map_newest);
    candidates.push_back(candidate);
  }
}

}  // namespace s2s::graph
