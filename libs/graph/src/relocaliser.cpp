#include "relocaliser.h"

#include <algorithm>

namespace s2s::graph {

namespace {

ConsistencyOptions withSupport(ConsistencyOptions options, int minSupport) {
  options.minSupport = minSupport;
  return options;
}

/// A believed fix this far from the estimate means that the survey lies elsewhere in the prior map.
constexpr double kElsewhere_m = 1.0;

}  // namespace

Relocaliser::Relocaliser(std::unique_ptr<PriorMap> prior, const RelocationOptions& options,
                         ConsistencyOptions consistency)
    : prior_(std::move(prior)), options_(options), consistency_(withSupport(consistency, options.minSupport)) {
  report_.wanted = prior_ != nullptr;
}

/// True if another candidate led the same keyframe to the same pose: that is the same evidence, not support.
bool Relocaliser::isKnown(const SurveyState& state, const LoopClosure& fix) const {
  constexpr double kSame_m = 1.0;
  return std::any_of(state.priorFixes.rbegin(), state.priorFixes.rend(), [&fix](const LoopClosure& other) {
    return other.to == fix.to && (other.T_from_to.translation() - fix.T_from_to.translation()).norm() < kSame_m;
  });
}

bool Relocaliser::due(const SurveyState& state) {
  const int newest = state.chain.size() - 1;
  if (report_.located && state.chain.travelled_m(lastTried_, newest) < options_.searchEvery_m) return false;
  lastTried_ = newest;
  return true;
}

RelocationChange Relocaliser::add(SurveyState& state) {
  if (!prior_ || !due(state)) return RelocationChange::none;
  const core::Isometry T_map_vehicle = state.keyframes.back().T_map_vehicle;
  if (report_.located) {
    if (prior_->distanceTo_m(T_map_vehicle.translation()) > options_.radius_m) return RelocationChange::none;
    ++report_.registered;
    tryPose(state, T_map_vehicle);
  } else {
    for (const auto& T_prior_vehicle : prior_->placesLike(state.clouds_vehicle.back(), T_map_vehicle, options_))
      tryPose(state, T_prior_vehicle);
  }
  return applyChoice(state);
}

void Relocaliser::tryPose(SurveyState& state, const core::Isometry& T_prior_vehicle) {
  LoopClosure fix = prior_->registerAt(T_prior_vehicle, state.clouds_vehicle.back());
  // A measurement of an absolute pose is a closure to the prior map's origin, which all of them share as `from`.
  fix.from = 0;
  fix.to = state.chain.size() - 1;
  fix.source = ClosureSource::priorMap;
  if (fix.status != ClosureStatus::pending || isKnown(state, fix)) return;
  state.priorFixes.push_back(fix);
  considered_.push_back(state.priorFixes.size() - 1);
  consistency_.add(state.chain, fix);
}

RelocationChange Relocaliser::applyChoice(SurveyState& state) {
  bool changed = false;
  report_.believed = 0;
  const LoopClosure* newest = nullptr;
  for (std::size_t c = 0; c < considered_.size(); ++c) {
    LoopClosure& fix = state.priorFixes[considered_[c]];
    const bool chosen = consistency_.chosen()[c];
    const ClosureStatus unchosen = consistency_.waiting()[c] ? ClosureStatus::pending : ClosureStatus::rejectedByOthers;
    const ClosureStatus now = chosen ? ClosureStatus::accepted : unchosen;
    changed = changed || (now == ClosureStatus::accepted) != (fix.status == ClosureStatus::accepted);
    fix.status = now;
    if (!chosen) continue;
    ++report_.believed;
    newest = &fix;
  }
  const RelocationChange change = changed ? RelocationChange::some : RelocationChange::none;
  if (!newest) return change;
  const bool first = !report_.located;
  if (first) report_.locatedTime = state.keyframes.back().time;
  report_.located = true;
  const auto& T_map_vehicle = state.keyframes[static_cast<std::size_t>(newest->to)].T_map_vehicle;
  const double off_m = (newest->T_from_to.translation() - T_map_vehicle.translation()).norm();
  if (!first && off_m <= kElsewhere_m) return change;
  moveIntoPrior(state, *newest);
  return RelocationChange::moved;
}

void Relocaliser::moveIntoPrior(SurveyState& state, const LoopClosure& fix) const {
  const core::Isometry T_prior_map =
      fix.T_from_to * state.keyframes[static_cast<std::size_t>(fix.to)].T_map_vehicle.inverse();
  for (auto& keyframe : state.keyframes) keyframe.T_map_vehicle = T_prior_map * keyframe.T_map_vehicle;
}

}  // namespace s2s::graph
