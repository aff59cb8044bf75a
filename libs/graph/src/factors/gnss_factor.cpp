#include "s2s/graph/factors/gnss_factor.h"

namespace s2s::graph {

core::Isometry alignmentFromBlock(const double* block) {
  return core::isometryFromXyzYpr(block[0], block[1], block[2], block[3], 0, 0);
}

GnssFactor::GnssFactor(const Eigen::Vector3d& p_enu, const Eigen::Vector3d& p_vehicle_antenna,
                       const Eigen::Vector3d& sigma_m)
    : p_enu_(p_enu), p_vehicle_antenna_(p_vehicle_antenna), weights_(sigma_m.cwiseInverse()) {}

bool GnssFactor::Evaluate(double const* const* parameters, double* residual, double** jacobians) const {
  const core::Isometry T_map_vehicle = poseFromBlock(parameters[0]);
  const core::Isometry T_enu_map = alignmentFromBlock(parameters[1]);
  const Eigen::Vector3d p_map = T_map_vehicle * p_vehicle_antenna_;
  Eigen::Map<Eigen::Vector3d>{residual} = weights_.asDiagonal() * (T_enu_map * p_map - p_enu_);
  if (!jacobians) return true;
  if (jacobians[0]) {
    LocalJacobian<3> J(jacobians[0]);
    const Eigen::Matrix3d R_enu_vehicle = T_enu_map.linear() * T_map_vehicle.linear();
    J.local().leftCols<3>() = weights_.asDiagonal() * R_enu_vehicle;
    J.local().rightCols<3>() = -(weights_.asDiagonal() * R_enu_vehicle * core::skew(p_vehicle_antenna_));
  }
  if (jacobians[1]) {
    Eigen::Map<Eigen::Matrix<double, 3, kAlignmentSize, Eigen::RowMajor>> J(jacobians[1]);
    J.leftCols<3>() = weights_.asDiagonal();
    J.col(3) = weights_.asDiagonal() * Eigen::Vector3d::UnitZ().cross(T_enu_map.linear() * p_map);
  }
  return true;
}

}  // namespace s2s::graph
