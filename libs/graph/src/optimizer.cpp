#include "s2s/graph/optimizer.h"

#include <chrono>

#include "graph_problem.h"
#include "s2s/core/error.h"

namespace s2s::graph {

namespace {

std::unique_ptr<GraphProblem> makeProblem(const PoseGraph& graph) {
  if (graph.nodes.empty()) throw core::InputError("the pose graph has no node", "", "give it at least one pose");
  const auto index = nodeIndex(graph, "pose graph");
  countConnectedParts(graph);  // throws if a constraint names an unknown node
  std::vector<core::Isometry> poses;
  poses.reserve(graph.nodes.size());
  for (const auto& node : graph.nodes) poses.push_back(node.T_map_node);

  auto problem = std::make_unique<GraphProblem>(poses);
  for (const auto& constraint : graph.constraints)
    if (constraint.from != constraint.to)
      problem->addBetween(index.at(constraint.from), index.at(constraint.to), constraint.T_from_to,
                          constraint.information, nullptr);
  bool anyFixed = false;
  for (std::size_t n = 0; n < graph.nodes.size(); ++n)
    if (graph.nodes[n].fixed) {
      problem->fix(n);
      anyFixed = true;
    }
  if (!anyFixed) problem->fix(0);
  return problem;
}

}  // namespace

const char* solveStatusName(SolveStatus status) {
  switch (status) {
    case SolveStatus::converged:
      return "converged";
    case SolveStatus::iterationLimit:
      return "stopped at the iteration limit";
    case SolveStatus::failed:
      return "failed";
  }
  return "?";
}

double cost(const PoseGraph& graph) { return makeProblem(graph)->cost(); }

SolveSummary optimize(PoseGraph& graph, const OptimizerOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const auto problem = makeProblem(graph);
  SolveSummary summary = problem->solve(options);
  if (summary.status != SolveStatus::failed)
    for (std::size_t n = 0; n < graph.nodes.size(); ++n)
      if (!graph.nodes[n].fixed) graph.nodes[n].T_map_node = problem->poseAt(n);
  summary.time_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return summary;
}

}  // namespace s2s::graph
