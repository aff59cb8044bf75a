#include "s2s/graph/acoustic_submap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <tuple>

namespace s2s::graph {

AcousticCloud thinned(const AcousticCloud& points, double voxel_m, double leastSigma_m) {
  using Keyed = std::tuple<std::int32_t, std::int32_t, std::int32_t, std::size_t>;
  std::vector<Keyed> keyed;
  keyed.reserve(points.size());
  const auto scale = static_cast<float>(1 / voxel_m);
  for (std::size_t n = 0; n < points.size(); ++n) {
    if (!points[n].p.allFinite() || !(points[n].sigma_m > 0)) continue;
    const Eigen::Array3i cell = (points[n].p * scale).array().floor().cast<int>();
    keyed.emplace_back(cell.x(), cell.y(), cell.z(), n);
  }
  std::sort(keyed.begin(), keyed.end());
  const auto cellOf = [](const Keyed& k) { return std::make_tuple(std::get<0>(k), std::get<1>(k), std::get<2>(k)); };
  AcousticCloud out;
  for (std::size_t begin = 0; begin < keyed.size();) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix<double, 3, 2> shared_m = Eigen::Matrix<double, 3, 2>::Zero();
    double weights = 0;
    std::size_t end = begin;
    for (; end < keyed.size() && cellOf(keyed[end]) == cellOf(keyed[begin]); ++end) {
      const AcousticPoint& point = points[std::get<3>(keyed[end])];
      const double weight = 1 / (static_cast<double>(point.sigma_m) * point.sigma_m);
      sum += weight * point.p.cast<double>();
      shared_m += weight * point.shared_m.cast<double>();
      weights += weight;
    }
    out.push_back({(sum / weights).cast<float>(), static_cast<float>(std::max(leastSigma_m, std::sqrt(1 / weights))),
                   (shared_m / weights).cast<float>()});
    begin = end;
  }
  return out;
}

void appendTransformed(const core::Isometry& T, const AcousticCloud& points, AcousticCloud& to) {
  const Eigen::Isometry3f Tf = T.cast<float>();
  to.reserve(to.size() + points.size());
  for (const auto& point : points) to.push_back({Tf * point.p, point.sigma_m, Tf.linear() * point.shared_m});
}

}  // namespace s2s::graph
