#include "s2s/eval/map_entropy.h"

#include <mrpt/core/exceptions.h>

#include <Eigen/Eigenvalues>
#include <cmath>

namespace s2s::eval {

MapEntropy::MapEntropy(std::vector<Eigen::Vector3d> places, double radius_m)
    : places_(std::move(places)), moments_(places_.size()), radius_m_(radius_m) {
  ASSERT_(radius_m > 0);
  for (std::uint32_t i = 0; i < places_.size(); ++i) {
    const Eigen::Vector3i cell = cellOf(places_[i]);
    for (int n = 0; n < 27; ++n)
      placesNear_[keyOf(cell + Eigen::Vector3i(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1))].push_back(i);
  }
}

Eigen::Vector3i MapEntropy::cellOf(const Eigen::Vector3d& p) const {
  return (p / radius_m_).array().floor().matrix().cast<int>();
}

std::uint64_t MapEntropy::keyOf(const Eigen::Vector3i& cell) const {
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) key = key << 21U | (static_cast<std::uint32_t>(cell[axis]) & 0x1FFFFFU);
  return key;
}

void MapEntropy::add(const Eigen::Vector3d& p) {
  const auto near = placesNear_.find(keyOf(cellOf(p)));
  if (near == placesNear_.end()) return;
  for (const std::uint32_t i : near->second) {
    const Eigen::Vector3d d = p - places_[i];
    if (d.squaredNorm() > radius_m_ * radius_m_) continue;
    Moments& m = moments_[i];
    ++m.count;
    m.sum += d;
    m.squares += d * d.transpose();
  }
}

CloudCrispness MapEntropy::result() const {
  constexpr double kFloor_m2 = 1e-6;
  const double logTwoPiE = std::log(2 * M_PI) + 1;
  CloudCrispness crispness;
  std::vector<double> sigmas_m;
  double entropies = 0;
  for (const Moments& m : moments_) {
    if (m.count < kMinNeighbours) continue;
    const double n = m.count;
    const Eigen::Vector3d mean = m.sum / n;
    const Eigen::Matrix3d C = (m.squares / n - mean * mean.transpose()) * (n / (n - 1));
    const Eigen::Vector3d values =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(C, Eigen::EigenvaluesOnly).eigenvalues().cwiseMax(kFloor_m2);
    entropies += 0.5 * (3 * logTwoPiE + values.array().log().sum());
    sigmas_m.push_back(std::sqrt(values(0)));
  }
  crispness.evaluated = sigmas_m.size();
  if (!sigmas_m.empty()) crispness.meanEntropy = entropies / static_cast<double>(sigmas_m.size());
  crispness.planeSigma_m = summarise(std::move(sigmas_m));
  return crispness;
}

}  // namespace s2s::eval
