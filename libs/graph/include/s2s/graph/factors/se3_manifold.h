#pragma once

#include <ceres/manifold.h>

#include "s2s/core/transform.h"

namespace s2s::graph {

/// A pose as Ceres sees it: x y z qx qy qz qw of T_map_vehicle, seven numbers.
constexpr int kPoseSize = 7;

/// Reads and writes such a block; writing normalises nothing, as rotations of an Isometry are orthonormal.
core::Isometry poseFromBlock(const double* block);
void poseToBlock(const core::Isometry& T, double* block);

/// Rigid motions with a right (body) perturbation: T (+) (dt, dw) = (t + R dt, R exp(dw)).
///
/// The factors give their Jacobians with respect to the six numbers of that perturbation, in the first six columns of
/// the 7-column block that Ceres passes, the seventh zero. PlusJacobian is therefore the 7x6 identity: it undoes that
/// layout, and the product, which is all the solver and the covariance use, is the exact derivative. This saves a
/// dense product a factor and a detour over quaternion derivatives.
class Se3Manifold final : public ceres::Manifold {
 public:
  int AmbientSize() const override { return kPoseSize; }
  int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  bool Minus(const double* y, const double* x, double* y_minus_x) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;
};

/// The 6 local columns of a factor's Jacobian inside the row-major block Ceres passes; sets the seventh column to zero.
template <int Rows>
class LocalJacobian {
 public:
  using Block = Eigen::Matrix<double, Rows, kPoseSize, Eigen::RowMajor>;
  explicit LocalJacobian(double* data) : block_(data) { block_.template rightCols<1>().setZero(); }
  auto local() { return block_.template leftCols<6>(); }

 private:
  Eigen::Map<Block> block_;
};

}  // namespace s2s::graph
