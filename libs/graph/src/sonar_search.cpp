#include "sonar_search.h"

#include <algorithm>
#include <cmath>

namespace s2s::graph {

namespace {

ClosureStatus statusOf(AcousticFit fit) {
  switch (fit) {
    case AcousticFit::good:
      return ClosureStatus::pending;
    case AcousticFit::tooFewPoints:
    case AcousticFit::tooFewPartners:
      return ClosureStatus::rejectedOverlap;
    case AcousticFit::residualTooLarge:
      return ClosureStatus::rejectedResidual;
    case AcousticFit::degenerate:
      return ClosureStatus::rejectedDegenerate;
    case AcousticFit::ambiguous:
      return ClosureStatus::rejectedAmbiguous;
  }
  return ClosureStatus::rejectedOverlap;
}

/// The last keyframe not after a time; the first one if there is none.
int keyframeAt(const SurveyState& state, core::TimeNs time) {
  const auto after = std::upper_bound(state.keyframes.begin(), state.keyframes.end(), time,
                                      [](core::TimeNs t, const Keyframe& keyframe) { return t < keyframe.time; });
  return after == state.keyframes.begin() ? 0 : std::prev(after)->id;
}

core::Isometry between(const SurveyState& state, int from, int to) {
  return state.keyframes[static_cast<std::size_t>(from)].T_map_vehicle.inverse() *
         state.keyframes[static_cast<std::size_t>(to)].T_map_vehicle;
}

}  // namespace

/// Earlier submaps of one pass as one target.
struct SonarSearch::JoinedTarget {
  JoinedTarget(const AcousticCloud& points, const AcousticRegistrationOptions& options) : target(points, options) {}
  AcousticTarget target;
  Submap extent;
};

SonarSearch::Cell SonarSearch::cellOf(const Eigen::Vector3d& p) const {
  return {static_cast<std::int32_t>(std::floor(p.x() / options_.cell_m)),
          static_cast<std::int32_t>(std::floor(p.y() / options_.cell_m))};
}

void SonarSearch::describe(Submap& submap) const {
  std::map<Cell, std::pair<Eigen::Vector3d, int>> sums;
  for (const AcousticCloud* cloud : {&submap.stereo, &submap.swath})
    for (const auto& point : *cloud) {
      const Eigen::Vector3d p = point.p.cast<double>();
      auto& sum = sums.try_emplace(cellOf(p), Eigen::Vector3d::Zero(), 0).first->second;
      sum.first += p;
      ++sum.second;
    }
  for (const auto& [cell, sum] : sums) {
    submap.cells.push_back(cell);
    submap.samples.emplace_back(sum.first / sum.second);
    submap.centre += submap.samples.back();
  }
  if (!submap.samples.empty()) submap.centre /= static_cast<double>(submap.samples.size());
}

SonarSearch::Submap SonarSearch::prepared(const SurveyState& state, const AcousticSubmap& submap) const {
  Submap stored;
  stored.keyframe = keyframeAt(state, submap.time);
  const core::Isometry T_keyframe_submap =
      state.keyframes[static_cast<std::size_t>(stored.keyframe)].T_odom_vehicle.inverse() * submap.T_odom_vehicle;
  const auto& registration = options_.registration;
  for (const auto& [from, to] :
       {std::pair(&submap.stereo_vehicle, &stored.stereo), std::pair(&submap.swath_vehicle, &stored.swath)}) {
    AcousticCloud moved;
    appendTransformed(T_keyframe_submap, *from, moved);
    *to = thinned(moved, registration.voxel_m, registration.leastSigma_m);
  }
  describe(stored);
  return stored;
}

double SonarSearch::commonArea_m2(const Submap& target, const Submap& source,
                                  const core::Isometry& T_target_source) const {
  const auto common = std::count_if(source.samples.begin(), source.samples.end(), [&](const Eigen::Vector3d& p) {
    return std::binary_search(target.cells.begin(), target.cells.end(), cellOf(T_target_source * p));
  });
  return static_cast<double>(common) * options_.cell_m * options_.cell_m;
}

std::vector<SonarSearch::Candidate> SonarSearch::candidates(const SurveyState& state) const {
  const Submap& newest = submaps_.back();
  std::vector<Candidate> near;
  for (std::size_t s = 0; s + 1 < submaps_.size(); ++s) {
    const Submap& submap = submaps_[s];
    if (state.chain.travelled_m(submap.keyframe, newest.keyframe) < options_.minTravel_m) continue;
    const core::Isometry T = between(state, submap.keyframe, newest.keyframe);
    if ((T * newest.centre - submap.centre).norm() > options_.radius_m) continue;
    const double area_m2 = commonArea_m2(submap, newest, T);
    if (area_m2 > 0) near.push_back({s, area_m2});
  }
  std::stable_sort(near.begin(), near.end(), [](auto& a, auto& b) { return a.area_m2 > b.area_m2; });
  std::vector<Candidate> chosen;
  for (const Candidate& candidate : near) {
    if (static_cast<int>(chosen.size()) >= options_.passes) break;
    // Submaps beside a chosen one are joined with it.
    const bool samePass = std::any_of(chosen.begin(), chosen.end(), [&](const Candidate& other) {
      return state.chain.travelled_m(submaps_[other.submap].keyframe, submaps_[candidate.submap].keyframe) <
             options_.minTravel_m;
    });
    if (!samePass) chosen.push_back(candidate);
  }
  return chosen;
}

bool SonarSearch::isForgotten(const SurveyState& state, int older, int newer) const {
  if (options_.odometryMemory_m <= 0) return true;
  const Eigen::Vector3d place = state.chain.pose(older).translation();
  for (int k = older; k <= newer; ++k)
    if ((state.chain.pose(k).translation() - place).norm() > options_.odometryMemory_m) return true;
  return false;
}

const SonarSearch::JoinedTarget& SonarSearch::joinedAround(const SurveyState& state, const Submap& submap) {
  const auto found = joined_.find(submap.keyframe);
  if (found != joined_.end()) return *found->second;
  constexpr std::size_t kKept = 8;
  if (joined_.size() >= kKept) joined_.clear();
  // Over a few metres the odometry is better than the graph, which closures may be bending just now.
  Submap extent;
  for (const Submap& other : submaps_) {
    if (state.chain.travelled_m(other.keyframe, submap.keyframe) > options_.joined_m) continue;
    const core::Isometry T = state.chain.relative(submap.keyframe, other.keyframe);
    appendTransformed(T, other.stereo, extent.stereo);
    appendTransformed(T, other.swath, extent.swath);
  }
  describe(extent);
  AcousticCloud points = extent.stereo;
  points.insert(points.end(), extent.swath.begin(), extent.swath.end());
  const auto joined = std::make_shared<JoinedTarget>(points, options_.registration);
  joined->extent = std::move(extent);
  return *(joined_[submap.keyframe] = joined);
}

LoopClosure SonarSearch::registerTo(const SurveyState& state, const Submap& earlier) {
  const Submap& newest = submaps_.back();
  const JoinedTarget& joined = joinedAround(state, earlier);
  const core::Isometry T_initial = between(state, earlier.keyframe, newest.keyframe);
  AcousticCloud source = newest.swath;
  if (isForgotten(state, earlier.keyframe, newest.keyframe))
    source.insert(source.end(), newest.stereo.begin(), newest.stereo.end());
  const auto& cells = joined.extent.cells;
  source.erase(std::remove_if(source.begin(), source.end(),
                              [&](const AcousticPoint& point) {
                                return !std::binary_search(cells.begin(), cells.end(),
                                                           cellOf(T_initial * point.p.cast<double>()));
                              }),
               source.end());
  const core::Matrix6 drift = state.chain.covariance(earlier.keyframe, newest.keyframe);
  const double priorSigma_m = std::sqrt(drift.topLeftCorner<2, 2>().trace() / 2);
  const auto result = registerAcoustic(joined.target, source, T_initial, priorSigma_m, options_.registration);
  LoopClosure closure;
  closure.from = earlier.keyframe;
  closure.to = newest.keyframe;
  closure.T_from_to = result.T_target_source;
  closure.covariance = options_.correlatedFactors * result.covariance;
  closure.source = ClosureSource::sonar;
  closure.status = statusOf(result.fit);
  closure.overlap = result.overlap;
  closure.rmse_m = result.rmse_m;
  return closure;
}

std::vector<LoopClosure> SonarSearch::add(const SurveyState& state, const AcousticSubmap& submap) {
  std::vector<LoopClosure> closures;
  submaps_.push_back(prepared(state, submap));
  if (submaps_.back().samples.empty()) {
    submaps_.pop_back();
    return closures;
  }
  for (const Candidate& candidate : candidates(state)) {
    const Submap& earlier = submaps_[candidate.submap];
    const double area_m2 = commonArea_m2(joinedAround(state, earlier).extent, submaps_.back(),
                                         between(state, earlier.keyframe, submaps_.back().keyframe));
    if (area_m2 >= options_.minOverlap_m2) closures.push_back(registerTo(state, earlier));
  }
  return closures;
}

}  // namespace s2s::graph
