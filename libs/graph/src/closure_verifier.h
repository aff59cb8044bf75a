#pragma once

#include <map>
#include <memory>

#include "loop_search.h"

namespace s2s::graph {

/// A closure with measurement and verdict of a registration, still without its ends.
LoopClosure closureFrom(const RegistrationResult& result);

/// Registers the newest keyframe's cloud against the submap around a candidate.
class ClosureVerifier {
 public:
  ClosureVerifier(const LoopSearchOptions& loops, const RegistrationOptions& registration)
      : loops_(loops), registration_(registration) {}

  /// The closure with its measurement and, as far as the clouds tell, its status: pending if they fit.
  LoopClosure verify(const SurveyState& state, const ClosureCandidate& candidate);

 private:
  const RegistrationTarget& submapAround(const SurveyState& state, int keyframe);

  LoopSearchOptions loops_;
  RegistrationOptions registration_;
  std::map<int, std::unique_ptr<RegistrationTarget>> submaps_;  ///< the last few, by keyframe
};

}  // namespace s2s::graph
