#include "marginals.h"

#include <ceres/crs_matrix.h>

#include <algorithm>

namespace s2s::graph {

namespace {

Eigen::SparseMatrix<double> normalEquations(GraphProblem& problem, std::size_t poses) {
  // Poses first, so that pose k owns the columns 6 k to 6 k + 5; the rest follows in any order.
  ceres::Problem::EvaluateOptions options;
  for (std::size_t k = 0; k < poses; ++k) options.parameter_blocks.push_back(problem.pose(k));
  std::vector<double*> all;
  problem.problem().GetParameterBlocks(&all);
  std::vector<double*> sorted = options.parameter_blocks;
  std::sort(sorted.begin(), sorted.end());
  for (double* block : all)
    if (!problem.problem().IsParameterBlockConstant(block) && !std::binary_search(sorted.begin(), sorted.end(), block))
      options.parameter_blocks.push_back(block);
  ceres::CRSMatrix rows;
  problem.problem().Evaluate(options, nullptr, nullptr, nullptr, &rows);
  const Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>> J(
      rows.num_rows, rows.num_cols, static_cast<Eigen::Index>(rows.values.size()), rows.rows.data(), rows.cols.data(),
      rows.values.data());
  return Eigen::SparseMatrix<double>(J.transpose() * J);
}

}  // namespace

Marginals::Marginals(GraphProblem& problem, std::size_t poses) {
  factor_.compute(normalEquations(problem, poses));
  usable_ = factor_.info() == Eigen::Success && (factor_.vectorD().array() > 0).all();
}

std::optional<core::Matrix6> Marginals::of(std::size_t pose) const {
  const auto first = static_cast<Eigen::Index>(6 * pose);
  if (!usable_ || first + 6 > factor_.cols()) return std::nullopt;
  Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(factor_.cols(), 6);
  unit.middleRows<6>(first).setIdentity();
  const core::Matrix6 covariance = factor_.solve(unit).middleRows<6>(first);
  if (!covariance.allFinite()) return std::nullopt;
  return core::Matrix6(0.5 * (covariance + covariance.transpose()));
}

}  // namespace s2s::graph
