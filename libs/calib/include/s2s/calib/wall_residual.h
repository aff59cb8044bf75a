#pragma once

#include <Eigen/Core>

#include "s2s/calib/surface_residual.h"

namespace s2s::calib {

/// How far an echo's point lies from a wall, in standard deviations.
/// For ceres::AutoDiffCostFunction<WallResidual, 1, kSonarParameters, 1>.
struct WallResidual {
  Echo echo;
  const SonarState* sonar = nullptr;
  const PingMotion* motion = nullptr;
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();
  double offset_m = 0;
  double weight_perM = 1;

  template <class T>
  bool operator()(const T* const correction, const T* const soundSpeed, T* residual) const {
    const auto p = echoPoint<T>(echo, *sonar, *motion, correction, *soundSpeed);
    residual[0] = (T(normal.x()) * p.x() + T(normal.y()) * p.y() - T(offset_m)) * T(weight_perM);
    return true;
  }
};

}  // namespace s2s::calib
