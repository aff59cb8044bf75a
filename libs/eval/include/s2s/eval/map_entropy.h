#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "s2s/eval/statistics.h"

namespace s2s::eval {

/// How crisp a point cloud is, without any truth.
struct CloudCrispness {
  std::size_t evaluated = 0;  ///< places with enough neighbours
  double meanEntropy = 0;     ///< mean map entropy, nats; lower is crisper
  Summary planeSigma_m;       ///< standard deviation of the neighbours across their best plane
};

/// Mean map entropy h = mean of 1/2 ln det(2 pi e C) and mean plane deviation (Droeschel & Behnke 2014; Razlaw et al.
/// 2015), C the covariance of all points within `radius_m` of a place. The places are a sample of the points, but the
/// neighbours are all of them, met in a second run through the cloud. Both figures depend on the density of the points:
/// compare maps of the same survey, not of different ones. Eigenvalues of C are taken as (1 mm)² at least.
class MapEntropy {
 public:
  static constexpr std::uint32_t kMinNeighbours = 10;

  /// @pre `radius_m` > 0
  MapEntropy(std::vector<Eigen::Vector3d> places, double radius_m);

  /// To be called with every point of the cloud.
  void add(const Eigen::Vector3d& p);

  CloudCrispness result() const;

 private:
  struct Moments {
    std::uint32_t count = 0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();      ///< of offsets from the place
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();  ///< of their outer products
  };
  std::uint64_t keyOf(const Eigen::Vector3i& cell) const;
  Eigen::Vector3i cellOf(const Eigen::Vector3d& p) const;

  std::vector<Eigen::Vector3d> places_;
  std::vector<Moments> moments_;
  double radius_m_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> placesNear_;  ///< by cell of the side `radius_m_`
};

}  // namespace s2s::eval
