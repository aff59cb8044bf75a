#pragma once

#include <ceres/loss_function.h>
#include <ceres/problem.h>

#include <array>
#include <deque>
#include <memory>
#include <vector>

#include "s2s/graph/factors/gnss_factor.h"
#include "s2s/graph/factors/se3_manifold.h"
#include "s2s/graph/optimizer.h"

namespace s2s::graph {

/// A least-squares problem over poses, with their parameter blocks and what else they are tied to. Built anew for
/// each optimisation: that costs a few milliseconds and keeps no state that could disagree with the graph.
class GraphProblem {
 public:
  explicit GraphProblem(const std::vector<core::Isometry>& poses);

  ceres::Problem& problem() { return problem_; }
  double* pose(std::size_t node) { return poses_[node].data(); }
  core::Isometry poseAt(std::size_t node) const { return poseFromBlock(poses_[node].data()); }
  void fix(std::size_t node) { problem_.SetParameterBlockConstant(pose(node)); }

  /// A block of one number that lives as long as the problem.
  double* addScalar(double value);
  /// The block of T_enu_map.
  double* addAlignment(const std::array<double, kAlignmentSize>& value);

  /// Constraint between nodes a and b; `loss` may be null.
  ceres::ResidualBlockId addBetween(std::size_t a, std::size_t b, const core::Isometry& T_a_b,
                                    const core::Matrix6& information, ceres::LossFunction* loss);
  /// Constraint of one node to a pose in the map.
  void addPrior(std::size_t node, const core::Isometry& T_map_node, const core::Matrix6& information,
                ceres::LossFunction* loss = nullptr);
  /// Any other factor; the problem owns factor and loss.
  ceres::ResidualBlockId add(ceres::CostFunction* factor, ceres::LossFunction* loss,
                             const std::vector<double*>& blocks) {
    return problem_.AddResidualBlock(factor, loss, blocks);
  }

  double cost();
  SolveSummary solve(const OptimizerOptions& options);

 private:
  using PoseBlock = std::array<double, kPoseSize>;
  Se3Manifold manifold_;
  std::vector<PoseBlock> poses_;
  std::deque<PoseBlock> anchors_;
  std::deque<double> scalars_;
  std::deque<std::array<double, kAlignmentSize>> alignments_;
  ceres::Problem problem_;
};

}  // namespace s2s::graph
