#pragma once

#include <ceres/sized_cost_function.h>

#include "s2s/graph/factors/se3_manifold.h"

namespace s2s::graph {

/// A floating vessel's height above the water surface: (z_map_vehicle - level - offset) / sigma, with the surface's
/// height `level` in the map an unknown of its own.
class WaterlineFactor final : public ceres::SizedCostFunction<1, kPoseSize, 1> {
 public:
  /// @param height_m height of the vehicle's origin above the surface at rest
  WaterlineFactor(double height_m, double sigma_m) : height_m_(height_m), weight_(1 / sigma_m) {}
  bool Evaluate(double const* const* parameters, double* residual, double** jacobians) const override;

 private:
  double height_m_, weight_;
};

/// Slow change of the surface's height between two times: (level_b - level_a) / sigma.
class WaterlineDriftFactor final : public ceres::SizedCostFunction<1, 1, 1> {
 public:
  explicit WaterlineDriftFactor(double sigma_m) : weight_(1 / sigma_m) {}
  bool Evaluate(double const* const* levels, double* residual, double** jacobians) const override;

 private:
  double weight_;
};

}  // namespace s2s::graph
