#include "s2s/graph/factors/gravity_factor.h"

namespace s2s::graph {

GravityFactor::GravityFactor(const Eigen::Vector3d& up_vehicle, double sigma_rad)
    : up_vehicle_(up_vehicle.normalized()), weight_(1 / sigma_rad) {}

bool GravityFactor::Evaluate(double const* const* poses, double* residual, double** jacobians) const {
  const Eigen::Map<const Eigen::Quaterniond> q(poses[0] + 3);
  const Eigen::Vector3d up = q.conjugate() * Eigen::Vector3d::UnitZ();
  Eigen::Map<Eigen::Vector3d>{residual} = weight_ * (up - up_vehicle_);
  if (!jacobians || !jacobians[0]) return true;
  LocalJacobian<3> J(jacobians[0]);
  J.local().leftCols<3>().setZero();
  J.local().rightCols<3>() = weight_ * core::skew(up);
  return true;
}

}  // namespace s2s::graph
