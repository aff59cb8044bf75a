#pragma once

#include <Eigen/SparseCholesky>
#include <optional>

#include "graph_problem.h"

namespace s2s::graph {

/// Covariances of single poses from one factorisation of a problem's normal equations at its present values.
class Marginals {
 public:
  explicit Marginals(GraphProblem& problem, std::size_t poses);
  /// Covariance of a body perturbation of a pose; nothing if the equations are singular.
  std::optional<core::Matrix6> of(std::size_t pose) const;

 private:
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
  bool usable_ = false;
};

}  // namespace s2s::graph
