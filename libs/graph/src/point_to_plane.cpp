#include "point_to_plane.h"

#include <Eigen/Cholesky>

namespace s2s::graph {

core::Vector6 addPointToPlane(const Eigen::Vector3d& p_source, const Eigen::Vector3d& normal_source, double residual_m,
                              double weight, double tiltVariance_rad2, odometry::NormalEquations& equations) {
  Eigen::Matrix<double, 6, 3> byNormal;
  byNormal << Eigen::Matrix3d::Identity(), core::skew(p_source);
  core::Vector6 h = byNormal * normal_source;
  const Eigen::Matrix3d tangent = Eigen::Matrix3d::Identity() - normal_source * normal_source.transpose();
  equations.A += weight * h * h.transpose();
  equations.b += weight * residual_m * h;
  equations.pretended += weight * tiltVariance_rad2 * byNormal * tangent * byNormal.transpose();
  equations.meanLever2_m2 += p_source.squaredNorm();
  ++equations.matches;
  return h;
}

core::Vector6 determinedStep(const odometry::NormalEquations& equations) {
  core::Matrix6 A = equations.A;
  A.diagonal().array() += 1e-9 * A.trace() + 1e-12;
  return -A.ldlt().solve(equations.b);
}

void applyStep(const core::Vector6& step, core::Isometry& T) {
  T.translate(Eigen::Vector3d(step.head<3>()));
  T.rotate(core::expSo3(step.tail<3>()));
}

core::Matrix6 covarianceFrom(core::Matrix6 information, const core::Vector6& floorSigma) {
  constexpr double kUnknown_m = 10, kUnknown_rad = 0.3;
  information.diagonal().head<3>().array() += 1 / (kUnknown_m * kUnknown_m);
  information.diagonal().tail<3>().array() += 1 / (kUnknown_rad * kUnknown_rad);
  core::Matrix6 covariance = information.ldlt().solve(core::Matrix6::Identity());
  covariance.diagonal() += floorSigma.cwiseAbs2();
  return 0.5 * (covariance + covariance.transpose());
}

}  // namespace s2s::graph
