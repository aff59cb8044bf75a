#include "s2s/graph/factors/between_factor.h"

#include <Eigen/Eigenvalues>

namespace s2s::graph {

core::Matrix6 squareRootOfInformation(const core::Matrix6& information) {
  const Eigen::LLT<core::Matrix6> cholesky(information);
  if (cholesky.info() == Eigen::Success) return cholesky.matrixU();
  const Eigen::SelfAdjointEigenSolver<core::Matrix6> eigen(information);
  return eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() * eigen.eigenvectors().transpose();
}

BetweenFactor::BetweenFactor(const core::Isometry& T_a_b_measured, const core::Matrix6& information)
    : t_measured_(T_a_b_measured.translation()),
      q_measured_(Eigen::Quaterniond(T_a_b_measured.linear()).normalized()),
      R_measuredInverse_(q_measured_.conjugate().toRotationMatrix()),
      sqrtInformation_(squareRootOfInformation(information)) {}

bool BetweenFactor::Evaluate(double const* const* poses, double* residual, double** jacobians) const {
  const Eigen::Map<const Eigen::Vector3d> p_a(poses[0]), p_b(poses[1]);
  const Eigen::Map<const Eigen::Quaterniond> q_a(poses[0] + 3), q_b(poses[1] + 3);
  const Eigen::Vector3d t_a_b = q_a.conjugate() * (p_b - p_a);
  const Eigen::Quaterniond q_a_b = q_a.conjugate() * q_b;
  Eigen::Quaterniond D = q_measured_.conjugate() * q_a_b;
  if (D.w() < 0) D.coeffs() = -D.coeffs();

  core::Vector6 error;
  error << R_measuredInverse_ * (t_a_b - t_measured_), 2 * D.vec();
  Eigen::Map<core::Vector6>{residual} = sqrtInformation_ * error;
  if (!jacobians) return true;
  if (jacobians[0]) jacobianA(t_a_b, D, jacobians[0]);
  if (jacobians[1]) jacobianB(q_a_b.toRotationMatrix(), D, jacobians[1]);
  return true;
}

void BetweenFactor::jacobianA(const Eigen::Vector3d& t_a_b, const Eigen::Quaterniond& D, double* data) const {
  // exp(-dw) on the left of T_a_b becomes exp(-R_measured^T dw) on the left of D.
  core::Matrix6 J = core::Matrix6::Zero();
  J.topLeftCorner<3, 3>() = -R_measuredInverse_;
  J.topRightCorner<3, 3>() = R_measuredInverse_ * core::skew(t_a_b);
  J.bottomRightCorner<3, 3>() = -(D.w() * Eigen::Matrix3d::Identity() - core::skew(D.vec())) * R_measuredInverse_;
  LocalJacobian<6>(data).local() = sqrtInformation_ * J;
}

void BetweenFactor::jacobianB(const Eigen::Matrix3d& R_a_b, const Eigen::Quaterniond& D, double* data) const {
  core::Matrix6 J = core::Matrix6::Zero();
  J.topLeftCorner<3, 3>() = R_measuredInverse_ * R_a_b;
  J.bottomRightCorner<3, 3>() = D.w() * Eigen::Matrix3d::Identity() + core::skew(D.vec());
  LocalJacobian<6>(data).local() = sqrtInformation_ * J;
}

}  // namespace s2s::graph
