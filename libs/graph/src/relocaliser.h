#pragma once

#include <memory>

#include "s2s/graph/prior_map.h"
#include "survey_state.h"

namespace s2s::graph {

enum class RelocationChange {
  none,
  some,  ///< other measurements are believed than before
  moved  ///< all keyframes were moved into the frame of the prior map
};

/// Ties a survey to a map made before: finds its place by descriptor and registration, and keeps registering along the
/// way. What it measures are absolute poses, which must agree with each other along the odometry as loop closures do.
class Relocaliser {
 public:
  Relocaliser(std::unique_ptr<PriorMap> prior, const RelocationOptions& options, ConsistencyOptions consistency);

  /// Tries the newest keyframe. Once the place is found, all keyframes are moved into the frame of the prior map.
  RelocationChange add(SurveyState& state);

  const RelocationReport& report() const { return report_; }

 private:
  bool due(const SurveyState& state);
  void tryPose(SurveyState& state, const core::Isometry& T_prior_vehicle);
  bool isKnown(const SurveyState& state, const LoopClosure& fix) const;
  RelocationChange applyChoice(SurveyState& state);
  void moveIntoPrior(SurveyState& state, const LoopClosure& fix) const;

  std::unique_ptr<PriorMap> prior_;
  RelocationOptions options_;
  ConsistencySet consistency_;
  std::vector<std::size_t> considered_;  ///< number in state.priorFixes of each closure in consistency_
  int lastTried_ = -1;
  RelocationReport report_;
};

}  // namespace s2s::graph
