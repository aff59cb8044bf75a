#pragma once

#include <string>

#include "s2s/graph/pose_graph.h"

namespace s2s::graph {

struct OptimizerOptions {
  int maxIterations = 100;
  /// Stops when a step lowers the cost by less than this share of it.
  double costTolerance = 1e-9;
  int threads = 1;
};

enum class SolveStatus {
  converged,
  iterationLimit,  ///< usable, but not at the minimum
  failed           ///< the poses were left as they were
};
const char* solveStatusName(SolveStatus status);

struct SolveSummary {
  SolveStatus status = SolveStatus::failed;
  double initialCost = 0, finalCost = 0;  ///< half the sum of squared whitened residuals (after robust losses)
  int iterations = 0;
  double time_s = 0;  ///< building the problem and solving it
  std::string message;
};

/// Half the sum of squared whitened residuals of all constraints: what `optimize` minimises. The residual is that of
/// `BetweenFactor`, equal to half of g2o's chi2.
/// @throws core::InputError if a constraint names a node that does not exist
double cost(const PoseGraph& graph);

/// Moves the nodes to the least-squares optimum (no robust losses). If no node is fixed, the first one is held.
/// @throws core::InputError if there is no node or a constraint names a node that does not exist
SolveSummary optimize(PoseGraph& graph, const OptimizerOptions& options = {});

}  // namespace s2s::graph
