#include "closure_verifier.h"

namespace s2s::graph {

namespace {

ClosureStatus statusOf(RegistrationStatus status) {
  switch (status) {
    case RegistrationStatus::converged:
      return ClosureStatus::pending;
    case RegistrationStatus::tooFewPartners:
      return ClosureStatus::rejectedOverlap;
    case RegistrationStatus::residualTooLarge:
      return ClosureStatus::rejectedResidual;
    case RegistrationStatus::degenerate:
      return ClosureStatus::rejectedDegenerate;
  }
  return ClosureStatus::rejectedOverlap;
}

}  // namespace

LoopClosure closureFrom(const RegistrationResult& result) {
  LoopClosure closure;
  closure.T_from_to = result.T_target_source;
  closure.covariance = result.covariance;
  closure.status = statusOf(result.status);
  closure.overlap = result.overlap;
  closure.rmse_m = result.rmse_m;
  return closure;
}

const RegistrationTarget& ClosureVerifier::submapAround(const SurveyState& state, int keyframe) {
  const auto found = submaps_.find(keyframe);
  if (found != submaps_.end()) return *found->second;
  constexpr std::size_t kKept = 8;
  if (submaps_.size() >= kKept) submaps_.clear();

  // Over a few metres the odometry is better than the graph, which loop closures may be bending just now.
  Cloud points;
  for (int direction : {-1, 1})
    for (int k = direction < 0 ? keyframe : keyframe + 1; k >= 0 && k < state.chain.size(); k += direction) {
      if (state.chain.travelled_m(k, keyframe) > loops_.submap_m) break;
      appendTransformed(state.chain.relative(keyframe, k), state.clouds_vehicle[k], points);
    }
  return *(submaps_[keyframe] = std::make_unique<RegistrationTarget>(points, registration_));
}

LoopClosure ClosureVerifier::verify(const SurveyState& state, const ClosureCandidate& candidate) {
  LoopClosure closure = closureFrom(registerCloud(submapAround(state, candidate.keyframe), state.clouds_vehicle.back(),
                                                  candidate.T_candidate_newest, registration_));
  closure.from = candidate.keyframe;
  closure.to = state.chain.size() - 1;
  closure.source = candidate.source;
  return closure;
}

}  // namespace s2s::graph
