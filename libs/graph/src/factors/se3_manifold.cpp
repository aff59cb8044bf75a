#include "s2s/graph/factors/se3_manifold.h"

namespace s2s::graph {

core::Isometry poseFromBlock(const double* block) {
  core::Isometry T = core::Isometry::Identity();
  T.linear() = Eigen::Map<const Eigen::Quaterniond>(block + 3).normalized().toRotationMatrix();
  T.translation() = Eigen::Map<const Eigen::Vector3d>(block);
  return T;
}

void poseToBlock(const core::Isometry& T, double* block) {
  Eigen::Map<Eigen::Vector3d>{block} = T.translation();
  Eigen::Map<Eigen::Quaterniond>{block + 3} = Eigen::Quaterniond(T.linear()).normalized();
}

bool Se3Manifold::Plus(const double* x, const double* delta, double* x_plus_delta) const {
  const Eigen::Map<const Eigen::Quaterniond> q(x + 3);
  const Eigen::Map<const Eigen::Vector3d> dt(delta), dw(delta + 3);
  Eigen::Map<Eigen::Vector3d>{x_plus_delta} = Eigen::Map<const Eigen::Vector3d>(x) + q * dt;
  const double angle = dw.norm();
  const double sincHalf = angle < 1e-6 ? 0.5 - angle * angle / 48.0 : std::sin(0.5 * angle) / angle;
  const Eigen::Quaterniond step(std::cos(0.5 * angle), sincHalf * dw.x(), sincHalf * dw.y(), sincHalf * dw.z());
  Eigen::Map<Eigen::Quaterniond>{x_plus_delta + 3} = (q * step).normalized();
  return true;
}

bool Se3Manifold::PlusJacobian(const double*, double* jacobian) const {
  Eigen::Map<Eigen::Matrix<double, kPoseSize, 6, Eigen::RowMajor>>(jacobian).setIdentity();
  return true;
}

bool Se3Manifold::Minus(const double* y, const double* x, double* y_minus_x) const {
  const core::Isometry D = poseFromBlock(x).inverse() * poseFromBlock(y);
  Eigen::Map<Eigen::Vector3d>{y_minus_x} = D.translation();
  Eigen::Map<Eigen::Vector3d>{y_minus_x + 3} = core::logSo3(D.linear());
  return true;
}

bool Se3Manifold::MinusJacobian(const double*, double* jacobian) const {
  Eigen::Map<Eigen::Matrix<double, 6, kPoseSize, Eigen::RowMajor>>(jacobian).setIdentity();
  return true;
}

}  // namespace s2s::graph
