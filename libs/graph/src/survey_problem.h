#pragma once

#include <memory>

#include "graph_problem.h"
#include "survey_state.h"

namespace s2s::graph {

/// A survey as a least-squares problem, with the blocks whose values are wanted afterwards.
struct SurveyProblem {
  std::unique_ptr<GraphProblem> graph;
  GnssReport gnss;
  double* alignment = nullptr;       ///< block of T_enu_map; null unless GNSS is trusted
  std::vector<double*> waterLevels;  ///< for each keyframe; empty without waterline prior
};

/// Builds the problem at the present estimate. The first keyframe is held: position and heading always, roll and pitch
/// only if there is no gravity.
SurveyProblem makeSurveyProblem(const SurveyState& state, const GraphSlamOptions& options);

/// Information of the odometry step that ends at keyframe k, with the drift floor of the options.
core::Matrix6 stepInformation(const OdometryChain& chain, int k);

}  // namespace s2s::graph
