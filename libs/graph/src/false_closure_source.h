#pragma once

#include <random>

#include "s2s/graph/false_closures.h"
#include "survey_state.h"

namespace s2s::graph {

/// Makes the wrong closures of FalseClosureOptions.
class FalseClosureSource {
 public:
  FalseClosureSource(const FalseClosureOptions& options, const LoopSearchOptions& loops,
                     const ConsistencyOptions& consistency, const RegistrationOptions& registration)
      : options_(options),
        loops_(loops),
        consistency_(consistency),
        registration_(registration),
        engine_(static_cast<unsigned>(options.seed)) {}

  /// The wrong closures to the newest keyframe that go with so many honest candidates.
  std::vector<LoopClosure> make(const SurveyState& state, int honestCandidates);

 private:
  LoopClosure makeOne(const SurveyState& state, int olderKeyframes);
  core::Isometry farOff(const core::Isometry& T_from_to);
  core::Isometry withinTheGate(const SurveyState& state, const LoopClosure& closure);
  double uniform(double low, double high) { return low + (high - low) * (engine_() / 4294967296.0); }
  double normal();

  FalseClosureOptions options_;
  LoopSearchOptions loops_;
  ConsistencyOptions consistency_;
  RegistrationOptions registration_;
  std::mt19937 engine_;
  double due_ = 0;
  int made_ = 0;
};

}  // namespace s2s::graph
