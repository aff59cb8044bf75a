#pragma once

#include <ceres/sized_cost_function.h>

#include "s2s/graph/factors/se3_manifold.h"

namespace s2s::graph {

/// Size of the block that aligns the map with the local east-north-up frame: x y z [m], yaw [rad] of T_enu_map.
constexpr int kAlignmentSize = 4;

/// T_enu_map from such a block; both frames have z up.
core::Isometry alignmentFromBlock(const double* block);

/// Position of a GNSS antenna: S (T_enu_map T_map_vehicle p_vehicle_antenna - p_enu), S the inverse standard
/// deviations.
class GnssFactor final : public ceres::SizedCostFunction<3, kPoseSize, kAlignmentSize> {
 public:
  GnssFactor(const Eigen::Vector3d& p_enu, const Eigen::Vector3d& p_vehicle_antenna, const Eigen::Vector3d& sigma_m);
  bool Evaluate(double const* const* parameters, double* residual, double** jacobians) const override;

 private:
  Eigen::Vector3d p_enu_, p_vehicle_antenna_, weights_;
};

}  // namespace s2s::graph
