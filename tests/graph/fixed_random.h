#pragma once

#include <cmath>
#include <random>

#include "s2s/core/transform.h"

namespace s2s::graph::test {

/// Random numbers that are the same with every standard library (its distributions are not).
class FixedRandom {
 public:
  explicit FixedRandom(unsigned seed) : engine_(seed) {}
  double uniform(double low, double high) { return low + (high - low) * (engine_() / 4294967296.0); }
  /// Box-Muller.
  double normal(double sigma = 1) {
    const double radius = std::sqrt(-2 * std::log(1 - uniform(0, 1)));
    return sigma * radius * std::cos(uniform(0, 2 * M_PI));
  }
  Eigen::Vector3d normal3(double sigma) {
    const double x = normal(sigma), y = normal(sigma), z = normal(sigma);
    return {x, y, z};
  }
  core::Vector6 normal6(double translation, double rotation) {
    core::Vector6 v;
    v.head<3>() = normal3(translation);
    v.tail<3>() = normal3(rotation);
    return v;
  }
  core::Isometry pose(double metres, double radians) {
    core::Isometry T = core::Isometry::Identity();
    T.translation() = normal3(metres);
    T.linear() = core::expSo3(normal3(radians));
    return T;
  }

 private:
  std::mt19937 engine_;
};

/// T perturbed on the right: translation and rotation vector in the body's frame.
inline core::Isometry perturbed(const core::Isometry& T, const core::Vector6& d) {
  core::Isometry result = T;
  result.translation() += T.linear() * d.head<3>();
  result.linear() = T.linear() * core::expSo3(d.tail<3>());
  return result;
}

/// Inverse of `perturbed` (to first order in the rotation's coupling).
inline core::Vector6 difference(const core::Isometry& T, const core::Isometry& perturbedT) {
  const core::Isometry D = T.inverse() * perturbedT;
  core::Vector6 d;
  d << D.translation(), core::logSo3(D.linear());
  return d;
}

inline core::Matrix6 diagonalCovariance(double sigma_m, double sigma_rad) {
  core::Vector6 variances;
  variances << Eigen::Vector3d::Constant(sigma_m * sigma_m), Eigen::Vector3d::Constant(sigma_rad * sigma_rad);
  return variances.asDiagonal();
}

}  // namespace s2s::graph::test
