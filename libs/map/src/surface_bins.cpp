#include "surface_bins.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace s2s::map {

namespace {

constexpr double kMadToSigma = 1.4826;  // of a normal distribution

/// Weighted median of the absolute deviations of the bins' mean heights.
double medianDeviation(const SurfaceBins& bins, double centre) {
  std::vector<std::pair<double, double>> deviations;
  deviations.reserve(bins.size());
  for (const auto& bin : bins) deviations.emplace_back(std::abs(bin.weightedHeight / bin.weight - centre), bin.weight);
  std::sort(deviations.begin(), deviations.end());
  const double half = 0.5 * totalWeight(bins);
  double sum = 0;
  for (const auto& [deviation, weight] : deviations) {
    sum += weight;
    if (sum >= half) return deviation;
  }
  return 0;
}

/// Adds one sounding to its bin, or takes it out; a bin left empty goes, and with it what rounding left of its sums.
void change(SurfaceBins& bins, int height_cm, double weight, double height_m, int sign) {
  auto bin = std::lower_bound(bins.begin(), bins.end(), height_cm,
                              [](const SurfaceBin& b, int height) { return b.height_cm < height; });
  const bool exists = bin != bins.end() && bin->height_cm == height_cm;
  if (!exists && sign < 0) return;
  if (!exists) bin = bins.insert(bin, SurfaceBin{height_cm});
  bin->count += static_cast<std::uint32_t>(sign);
  bin->weight += sign * weight;
  bin->weightedHeight += sign * weight * height_m;
  if (bin->count == 0) bins.erase(bin);
}

}  // namespace

double totalWeight(const SurfaceBins& bins) {
  double sum = 0;
  for (const auto& bin : bins) sum += bin.weight;
  return sum;
}

std::uint32_t totalCount(const SurfaceBins& bins) {
  std::uint32_t sum = 0;
  for (const auto& bin : bins) sum += bin.count;
  return sum;
}

std::size_t quantileBin(const SurfaceBins& bins, double quantile) {
  const double target = quantile * totalWeight(bins);
  double sum = 0;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    sum += bins[i].weight;
    if (sum >= target) return i;
  }
  return bins.size() - 1;
}

SurfaceMiddle middleOf(const SurfaceBins& bins, std::uint32_t pings) {
  const SurfaceBin& middle = bins[quantileBin(bins, 0.5)];
  SurfaceMiddle result;
  result.value_m = middle.weightedHeight / middle.weight;
  const double scatter_m = kMadToSigma * medianDeviation(bins, result.value_m);
  const double claimed = totalCount(bins) / totalWeight(bins);
  result.sigma_m = std::sqrt((claimed + pings * scatter_m * scatter_m) / (1.0 + pings));
  return result;
}

void enterValue(SurfaceColumn& column, double value_m, double sigma_m, core::TimeNs time, int sign) {
  change(column.bins, static_cast<int>(std::floor(value_m * kBinsPerMetre)), 1 / (sigma_m * sigma_m), value_m, sign);
  core::TimeNs &last = sign > 0 ? column.lastAdded : column.lastRemoved,
               &other = sign > 0 ? column.lastRemoved : column.lastAdded;
  if (column.bins.empty()) {
    column.pings = 0;
    column.lastAdded = column.lastRemoved = 0;
    return;
  }
  if (column.pings == 0 || last != time) column.pings += static_cast<std::uint32_t>(sign);
  last = time;
  if (other == time) other = 0;  // the same ping may come again
}

}  // namespace s2s::map
