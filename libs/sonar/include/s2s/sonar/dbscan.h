#pragma once

#include <Eigen/Core>
#include <vector>

namespace s2s::sonar {

struct DbscanOptions {
  double epsilon_m = 0.20;  ///< paper
  int minPoints = 20;       ///< paper; counts the point itself, as Ester et al. do
};

constexpr int kNoise = -1;

/// DBSCAN by its definition (Ester, Kriegel, Sander, Xu, KDD 1996): a point with at least `minPoints` points within
/// `epsilon_m` (itself and the boundary included) is a core point; core points within `epsilon_m` of each other share
/// a cluster. A border point could belong to several clusters: it takes that of the nearest core point, of equally near
/// ones that with the lowest index, so the result does not depend on the order of the visit.
///
/// Exact, on a grid of cells whose diagonal is epsilon (Gunawan 2013): a full cell needs no neighbour search at all.
///
/// @return one label a point: kNoise, or clusters numbered from 0 in the order of their first core point
std::vector<int> dbscan(const std::vector<Eigen::Vector2d>& points, const DbscanOptions& options);

}  // namespace s2s::sonar
