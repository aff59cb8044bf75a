#include "graph_problem.h"

#include <ceres/solver.h>

#include "s2s/graph/factors/between_factor.h"

namespace s2s::graph {

namespace {

ceres::Problem::Options problemOptions() {
  ceres::Problem::Options options;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  return options;
}

ceres::Solver::Options solverOptions(const OptimizerOptions& options) {
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  solver.sparse_linear_algebra_library_type = ceres::SUITE_SPARSE;
  solver.max_num_iterations = options.maxIterations;
  solver.num_threads = options.threads;
  solver.function_tolerance = options.costTolerance;
  // Pose graphs are nearly Gauss-Newton problems: a wide first region saves the iterations that would widen it.
  solver.initial_trust_region_radius = 1e8;
  solver.logging_type = ceres::SILENT;
  return solver;
}

SolveStatus statusOf(const ceres::Solver::Summary& summary) {
  if (!summary.IsSolutionUsable()) return SolveStatus::failed;
  return summary.termination_type == ceres::CONVERGENCE ? SolveStatus::converged : SolveStatus::iterationLimit;
}

}  // namespace

GraphProblem::GraphProblem(const std::vector<core::Isometry>& poses)
    : poses_(poses.size()), problem_(problemOptions()) {
  for (std::size_t n = 0; n < poses.size(); ++n) {
    poseToBlock(poses[n], poses_[n].data());
    problem_.AddParameterBlock(poses_[n].data(), kPoseSize, &manifold_);
  }
}

double* GraphProblem::addScalar(double value) {
  scalars_.push_back(value);
  problem_.AddParameterBlock(&scalars_.back(), 1);
  return &scalars_.back();
}

double* GraphProblem::addAlignment(const std::array<double, kAlignmentSize>& value) {
  alignments_.push_back(value);
  problem_.AddParameterBlock(alignments_.back().data(), kAlignmentSize);
  return alignments_.back().data();
}

ceres::ResidualBlockId GraphProblem::addBetween(std::size_t a, std::size_t b, const core::Isometry& T_a_b,
                                                const core::Matrix6& information, ceres::LossFunction* loss) {
  return problem_.AddResidualBlock(new BetweenFactor(T_a_b, information), loss, pose(a), pose(b));
}

void GraphProblem::addPrior(std::size_t node, const core::Isometry& T_map_node, const core::Matrix6& information,
                            ceres::LossFunction* loss) {
  anchors_.emplace_back();
  double* anchor = anchors_.back().data();
  poseToBlock(core::Isometry::Identity(), anchor);
  problem_.AddParameterBlock(anchor, kPoseSize, &manifold_);
  problem_.SetParameterBlockConstant(anchor);
  problem_.AddResidualBlock(new BetweenFactor(T_map_node, information), loss, anchor, pose(node));
}

double GraphProblem::cost() {
  double cost = 0;
  problem_.Evaluate({}, &cost, nullptr, nullptr, nullptr);
  return cost;
}

SolveSummary GraphProblem::solve(const OptimizerOptions& options) {
  ceres::Solver::Summary ceresSummary;
  ceres::Solve(solverOptions(options), &problem_, &ceresSummary);
  SolveSummary summary;
  summary.status = statusOf(ceresSummary);
  summary.initialCost = ceresSummary.initial_cost;
  summary.finalCost = ceresSummary.final_cost;
  summary.iterations = ceresSummary.num_successful_steps + ceresSummary.num_unsuccessful_steps;
  summary.time_s = ceresSummary.total_time_in_seconds;
  summary.message = ceresSummary.message;
  return summary;
}

}  // namespace s2s::graph
