#pragma once

#include <ceres/sized_cost_function.h>

#include "s2s/graph/factors/se3_manifold.h"

namespace s2s::graph {

/// Roll and pitch of a node from the direction of gravity: (R_map_vehicle^T e_z - up_vehicle) / sigma.
class GravityFactor final : public ceres::SizedCostFunction<3, kPoseSize> {
 public:
  /// @param up_vehicle unit vector against gravity, in the vehicle frame
  /// @param sigma_rad  standard deviation of its direction about each horizontal axis
  GravityFactor(const Eigen::Vector3d& up_vehicle, double sigma_rad);
  bool Evaluate(double const* const* poses, double* residual, double** jacobians) const override;

 private:
  Eigen::Vector3d up_vehicle_;
  double weight_;
};

}  // namespace s2s::graph
