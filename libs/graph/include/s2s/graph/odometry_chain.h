#pragma once

#include <vector>

#include "s2s/core/transform.h"

namespace s2s::graph {

/// Adjoint of T for body perturbations ordered translation, rotation: T exp(d) = exp(Ad(T) d) T.
core::Matrix6 adjoint(const core::Isometry& T);

/// Relative poses along the odometry and their covariances, in constant time for any two keyframes.
///
/// The covariance of the motion i -> j is the sum of those of the steps between, each carried to j. Kept as running
/// sums in the odometry's frame, it is Ad(T_j^-1) (S_j - S_i) Ad(T_j^-1)^T.
class OdometryChain {
 public:
  void append(const core::Isometry& T_odom_vehicle, const core::Matrix6& motionCovariance);

  int size() const { return static_cast<int>(poses_.size()); }
  const core::Isometry& pose(int i) const { return poses_[i]; }
  core::Isometry relative(int i, int j) const { return poses_[i].inverse() * poses_[j]; }
  /// Covariance of a body perturbation of relative(i, j), for i, j in any order.
  core::Matrix6 covariance(int i, int j) const;
  /// Covariance of the last step as it was given.
  const core::Matrix6& stepCovariance(int i) const { return steps_[i]; }
  /// Metres travelled between the keyframes.
  double travelled_m(int i, int j) const { return std::abs(travelled_m_[j] - travelled_m_[i]); }

 private:
  std::vector<core::Isometry> poses_;
  std::vector<core::Matrix6> steps_, sums_;
  std::vector<double> travelled_m_;
};

}  // namespace s2s::graph
