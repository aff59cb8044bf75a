#include "s2s/graph/odometry_chain.h"

namespace s2s::graph {

core::Matrix6 adjoint(const core::Isometry& T) {
  core::Matrix6 Ad = core::Matrix6::Zero();
  Ad.topLeftCorner<3, 3>() = T.linear();
  Ad.topRightCorner<3, 3>() = core::skew(T.translation()) * T.linear();
  Ad.bottomRightCorner<3, 3>() = T.linear();
  return Ad;
}

void OdometryChain::append(const core::Isometry& T_odom_vehicle, const core::Matrix6& motionCovariance) {
  const core::Matrix6 Ad = adjoint(T_odom_vehicle);
  const bool first = poses_.empty();
  steps_.push_back(first ? core::Matrix6::Zero().eval() : motionCovariance);
  sums_.push_back(first ? core::Matrix6::Zero().eval()
                        : core::Matrix6(sums_.back() + Ad * motionCovariance * Ad.transpose()));
  travelled_m_.push_back(
      first ? 0 : travelled_m_.back() + (T_odom_vehicle.translation() - poses_.back().translation()).norm());
  poses_.push_back(T_odom_vehicle);
}

core::Matrix6 OdometryChain::covariance(int i, int j) const {
  const core::Matrix6 Ad = adjoint(poses_[j].inverse());
  const core::Matrix6 difference = j > i ? sums_[j] - sums_[i] : sums_[i] - sums_[j];
  const core::Matrix6 covariance = Ad * difference * Ad.transpose();
  return 0.5 * (covariance + covariance.transpose());
}

}  // namespace s2s::graph
