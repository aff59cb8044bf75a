#pragma once

#include <vector>

#include "survey_state.h"

namespace s2s::graph {

/// A keyframe that may see the same place as the newest one, and from where.
struct ClosureCandidate {
  int keyframe = 0;
  core::Isometry T_candidate_newest = core::Isometry::Identity();  ///< first guess
  ClosureSource source = ClosureSource::proximity;
};

/// Candidates for the newest keyframe: the nearest passes by estimated position, and places that look alike.
class LoopSearch {
 public:
  LoopSearch(const LoopSearchOptions& options, const ScanContextOptions& places) : options_(options), places_(places) {}

  /// Adds the newest keyframe's descriptor; call once a keyframe.
  void add(const SurveyState& state);
  /// True if the newest keyframe is far enough from the last one searched for.
  bool due(const SurveyState& state);
  std::vector<ClosureCandidate> find(const SurveyState& state) const;

 private:
  int olderKeyframes(const SurveyState& state) const;
  void findNear(const SurveyState& state, int count, std::vector<ClosureCandidate>& candidates) const;
  void findAlike(const SurveyState& state, int count, std::vector<ClosureCandidate>& candidates) const;

  LoopSearchOptions options_;
  PlaceDatabase places_;
  int lastSearched_ = -1;
};

}  // namespace s2s::graph
