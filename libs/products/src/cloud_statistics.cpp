#include "s2s/products/cloud_statistics.h"

#include <algorithm>
#include <cmath>

namespace s2s::products {

namespace {

constexpr double kLowest_m = -500, kHighest_m = 500, kBinsPerMetre = 10;
constexpr auto kBins = static_cast<std::size_t>((kHighest_m - kLowest_m) * kBinsPerMetre);

}  // namespace

bool CloudStatistics::add(const map::MapPoint& point) {
  const auto index = static_cast<std::size_t>(point.layer);
  LayerStatistics& layer = layers_[index];
  if (!point.p_map.allFinite()) {
    ++layer.notFinite;
    return false;
  }
  ++layer.count;
  layer.maxIntensity = std::max(layer.maxIntensity, static_cast<double>(point.intensity));
  layer.box.extend(point.p_map);
  auto& heights = heights_[index];
  if (heights.empty()) heights.assign(kBins, 0);
  const double z = std::clamp(point.p_map.z(), kLowest_m, kHighest_m - 0.5 / kBinsPerMetre);
  ++heights[static_cast<std::size_t>((z - kLowest_m) * kBinsPerMetre)];
  return true;
}

std::uint64_t CloudStatistics::count() const {
  std::uint64_t sum = 0;
  for (const auto& layer : layers_) sum += layer.count;
  return sum;
}

std::uint64_t CloudStatistics::notFinite() const {
  std::uint64_t sum = 0;
  for (const auto& layer : layers_) sum += layer.notFinite;
  return sum;
}

Eigen::AlignedBox3d CloudStatistics::box() const {
  Eigen::AlignedBox3d box;
  for (const auto& layer : layers_) box.extend(layer.box);
  return box;
}

double CloudStatistics::heightQuantile_m(const std::vector<map::Layer>& layers, double quantile) const {
  std::vector<std::uint64_t> sum(kBins, 0);
  std::uint64_t total = 0;
  for (const auto layer : layers) {
    const auto& heights = heights_[static_cast<std::size_t>(layer)];
    for (std::size_t i = 0; i < heights.size(); ++i) sum[i] += heights[i];
    total += layers_[static_cast<std::size_t>(layer)].count;
  }
  if (total == 0) return 0;
  const double target = quantile * static_cast<double>(total);
  double reached = 0;
  for (std::size_t i = 0; i < kBins; ++i) {
    reached += static_cast<double>(sum[i]);
    if (reached >= target) return kLowest_m + (static_cast<double>(i) + 0.5) / kBinsPerMetre;
  }
  return kHighest_m;
}

}  // namespace s2s::products
