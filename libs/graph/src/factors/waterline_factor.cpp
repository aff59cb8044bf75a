#include "s2s/graph/factors/waterline_factor.h"

namespace s2s::graph {

bool WaterlineFactor::Evaluate(double const* const* parameters, double* residual, double** jacobians) const {
  const Eigen::Map<const Eigen::Quaterniond> q(parameters[0] + 3);
  residual[0] = weight_ * (parameters[0][2] - parameters[1][0] - height_m_);
  if (!jacobians) return true;
  if (jacobians[0]) {
    LocalJacobian<1> J(jacobians[0]);
    J.local().leftCols<3>() = weight_ * q.toRotationMatrix().row(2);
    J.local().rightCols<3>().setZero();
  }
  if (jacobians[1]) jacobians[1][0] = -weight_;
  return true;
}

bool WaterlineDriftFactor::Evaluate(double const* const* levels, double* residual, double** jacobians) const {
  residual[0] = weight_ * (levels[1][0] - levels[0][0]);
  if (!jacobians) return true;
  if (jacobians[0]) jacobians[0][0] = -weight_;
  if (jacobians[1]) jacobians[1][0] = weight_;
  return true;
}

}  // namespace s2s::graph
