#pragma once

#include <ceres/sized_cost_function.h>

#include "s2s/graph/factors/se3_manifold.h"

namespace s2s::graph {

/// Relative pose of two nodes a, b against a measurement, from odometry or a loop closure.
///
/// With D = T_a_b_measured^-1 T_map_a^-1 T_map_b the residual is S (t_D, 2 sign(w) v), (v, w) the quaternion of D and
/// S^T S the information. It is g2o's EdgeSE3 error with the rotation in radians; 2 v equals the rotation vector up to
/// third order and, unlike it, has a bounded derivative everywhere.
class BetweenFactor final : public ceres::SizedCostFunction<6, kPoseSize, kPoseSize> {
 public:
  /// @param information of a body perturbation of T_a_b, translation before rotation; may be singular
  BetweenFactor(const core::Isometry& T_a_b_measured, const core::Matrix6& information);
  bool Evaluate(double const* const* poses, double* residual, double** jacobians) const override;

 private:
  void jacobianA(const Eigen::Vector3d& t_a_b, const Eigen::Quaterniond& D, double* data) const;
  void jacobianB(const Eigen::Matrix3d& R_a_b, const Eigen::Quaterniond& D, double* data) const;

  Eigen::Vector3d t_measured_;
  Eigen::Quaterniond q_measured_;
  Eigen::Matrix3d R_measuredInverse_;
  core::Matrix6 sqrtInformation_;
};

/// S with S^T S = information; negative eigenvalues, which only rounding can bring, count as zero.
core::Matrix6 squareRootOfInformation(const core::Matrix6& information);

}  // namespace s2s::graph
