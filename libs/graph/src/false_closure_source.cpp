#include "false_closure_source.h"

#include <Eigen/Cholesky>

namespace s2s::graph {

std::vector<LoopClosure> FalseClosureSource::make(const SurveyState& state, int honestCandidates) {
  std::vector<LoopClosure> closures;
  if (options_.share <= 0) return closures;
  due_ += honestCandidates * options_.share / (1 - options_.share);
  int older = state.chain.size();
  while (older > 0 && state.chain.travelled_m(older - 1, state.chain.size() - 1) < loops_.minTravel_m) --older;
  for (; due_ >= 1 && older > 0; due_ -= 1) closures.push_back(makeOne(state, older));
  return closures;
}

LoopClosure FalseClosureSource::makeOne(const SurveyState& state, int olderKeyframes) {
  LoopClosure closure;
  closure.from = static_cast<int>(uniform(0, olderKeyframes));
  closure.to = state.chain.size() - 1;
  core::Vector6 sigma;
  sigma << Eigen::Vector3d::Constant(registration_.floorTranslation_m),
      Eigen::Vector3d::Constant(registration_.floorRotation_rad);
  closure.covariance = sigma.array().square().matrix().asDiagonal();
  closure.source = ClosureSource::injected;
  closure.overlap = 1;
  const core::Isometry& T_map_from = state.keyframes[static_cast<std::size_t>(closure.from)].T_map_vehicle;
  core::Isometry T_map_to = state.keyframes.back().T_map_vehicle;
  closure.T_from_to = T_map_from.inverse() * T_map_to;
  switch (made_++ % 3) {
    case 0:
      closure.T_from_to = farOff(closure.T_from_to);
      break;
    case 1:
      closure.T_from_to = withinTheGate(state, closure);
      break;
    default:
      T_map_to.translation() += Eigen::Vector3d(options_.repeatedShift_m, options_.repeatedShift_m, 0);
      closure.T_from_to = T_map_from.inverse() * T_map_to;
  }
  return closure;
}

core::Isometry FalseClosureSource::farOff(const core::Isometry& T_from_to) {
  core::Isometry T = T_from_to;
  T.translation() += Eigen::Vector3d(uniform(-30, 30), uniform(-30, 30), uniform(-1, 1));
  T.linear() = T.linear() * core::expSo3(Eigen::Vector3d(0, 0, uniform(-M_PI, M_PI)));
  return T;
}

core::Isometry FalseClosureSource::withinTheGate(const SurveyState& state, const LoopClosure& closure) {
  const core::Matrix6 covariance = state.chain.covariance(closure.from, closure.to) + closure.covariance;
  core::Vector6 unit;
  for (int i = 0; i < 6; ++i) unit[i] = normal();
  const core::Matrix6 L = covariance.llt().matrixL();
  const core::Vector6 error = L * unit.normalized() * std::sqrt(2.0 / 3.0 * consistency_.chi2);
  core::Isometry T = state.chain.relative(closure.from, closure.to);
  T.translation() += T.linear() * error.head<3>();
  T.linear() = T.linear() * core::expSo3(error.tail<3>());
  return T;
}

double FalseClosureSource::normal() {
  const double radius = std::sqrt(-2 * std::log(1 - uniform(0, 1)));
  return radius * std::cos(uniform(0, 2 * M_PI));
}

}  // namespace s2s::graph
