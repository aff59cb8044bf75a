#include "s2s/map/surface_estimator.h"

#include <algorithm>
#include <cmath>

#include "surface_tiles.h"

namespace s2s::map {

namespace {

constexpr double kBinsPerMetre = 100;
constexpr double kMadToSigma = 1.4826;  // of a normal distribution
constexpr double kLargestIndex = 1e9;   // cell and bin indices beyond are not coordinates of a survey

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

/// Index of the bin in which the cumulative weight passes the share `quantile`.
std::size_t quantileBin(const SurfaceBins& bins, double quantile) {
  const double target = quantile * totalWeight(bins);
  double sum = 0;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    sum += bins[i].weight;
    if (sum >= target) return i;
  }
  return bins.size() - 1;
}

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

/// The lowest dense layer of a column that holds more than seabed.
SurfaceBins seabedLayer(const SurfaceBins& column, double window_m) {
  const int window_cm = static_cast<int>(std::lround(window_m * kBinsPerMetre));
  // Weight of the layer that begins at each bin, by two running indices.
  std::vector<double> layerWeight(column.size());
  std::size_t end = 0;
  double sum = 0;
  for (std::size_t begin = 0; begin < column.size(); ++begin) {
    while (end < column.size() && column[end].height_cm < column[begin].height_cm + window_cm)
      sum += column[end++].weight;
    layerWeight[begin] = sum;
    sum -= column[begin].weight;
  }
  const double heaviest = *std::max_element(layerWeight.begin(), layerWeight.end());
  std::size_t lowest = 0;
  while (layerWeight[lowest] < 0.5 * heaviest) ++lowest;
  // Upwards while it grows heavier, at most to twice its height: the layer is to hold the whole of the seabed's
  // scatter.
  std::size_t best = lowest;
  for (std::size_t i = lowest; i < column.size() && column[i].height_cm < column[lowest].height_cm + window_cm; ++i)
    if (layerWeight[i] > layerWeight[best]) best = i;
  SurfaceBins layer;
  for (std::size_t i = best; i < column.size() && column[i].height_cm < column[best].height_cm + window_cm; ++i)
    layer.push_back(column[i]);
  return layer;
}

enum class Verdict { Seabed, FewPoints, Wall };

Verdict estimate(SurfaceBins bins, std::uint32_t pings, const SurfaceOptions& options, SurfaceEstimator::Cell& cell) {
  const auto minPoints = static_cast<std::uint32_t>(options.minPoints);
  if (totalCount(bins) < minPoints) return Verdict::FewPoints;
  const int spread_cm = bins[quantileBin(bins, 0.95)].height_cm - bins[quantileBin(bins, 0.05)].height_cm;
  cell.doubtful = spread_cm > options.flatSpread_m * kBinsPerMetre;
  if (cell.doubtful) {
    SurfaceBins layer = seabedLayer(bins, options.window_m);
    if (totalWeight(layer) < options.minSeabedShare * totalWeight(bins)) return Verdict::Wall;
    bins = std::move(layer);
  }
  cell.count = totalCount(bins);
  if (cell.count < minPoints) return Verdict::FewPoints;
  const SurfaceBin& middle = bins[quantileBin(bins, 0.5)];
  cell.height_m = middle.weightedHeight / middle.weight;
  const double scatter_m = kMadToSigma * medianDeviation(bins, cell.height_m);
  const double claimed = cell.count / totalWeight(bins);
  cell.sigma_m = std::sqrt((claimed + pings * scatter_m * scatter_m) / (1.0 + pings));
  return Verdict::Seabed;
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

SurfaceEstimator::SurfaceEstimator(const SurfaceOptions& options) : options_(options) { clear(); }
SurfaceEstimator::~SurfaceEstimator() = default;
SurfaceEstimator::SurfaceEstimator(SurfaceEstimator&&) noexcept = default;
SurfaceEstimator& SurfaceEstimator::operator=(SurfaceEstimator&&) noexcept = default;

void SurfaceEstimator::clear() {
  tiles_ = std::make_unique<Tiles>(static_cast<std::size_t>(std::max(1, options_.maxTilesInMemory)));
  soundings_ = notFinite_ = 0;
}

void SurfaceEstimator::enter(const MapPoint& point, int sign) {
  if (point.layer == Layer::Lidar || point.isWall) return;
  const Eigen::Vector3d cellAndBin(point.p_map.x() / options_.cell_m, point.p_map.y() / options_.cell_m,
                                   point.p_map.z() * kBinsPerMetre);
  // NaN fails the comparison too; maxCoeff() would pass over it.
  if (!(cellAndBin.array().abs() < kLargestIndex).all() || !std::isfinite(point.sigma_m)) {
    notFinite_ += static_cast<std::uint64_t>(sign);
    return;
  }
  soundings_ += static_cast<std::uint64_t>(sign);
  const double sigma_m = std::max(static_cast<double>(point.sigma_m), options_.sigmaFloor_m);
  SurfaceColumn& column = tiles_->at(static_cast<std::int32_t>(std::floor(cellAndBin.x())),
                                     static_cast<std::int32_t>(std::floor(cellAndBin.y())));
  change(column.bins, static_cast<int>(std::floor(cellAndBin.z())), 1 / (sigma_m * sigma_m), point.p_map.z(), sign);
  core::TimeNs &last = sign > 0 ? column.lastAdded : column.lastRemoved,
               &other = sign > 0 ? column.lastRemoved : column.lastAdded;
  if (column.bins.empty()) {
    column.pings = 0;
    column.lastAdded = column.lastRemoved = 0;
    return;
  }
  if (column.pings == 0 || last != point.time) column.pings += static_cast<std::uint32_t>(sign);
  last = point.time;
  if (other == point.time) other = 0;  // the same ping may come again
}

SurfaceStatistics SurfaceEstimator::forEachCell(double waterHeight_m,
                                                const std::function<void(const Cell&)>& visit) const {
  SurfaceStatistics statistics;
  statistics.soundings = soundings_ + notFinite_;
  statistics.notFinite = notFinite_;
  const double ceiling_cm = (waterHeight_m - options_.minDepth_m) * kBinsPerMetre;
  tiles_->forEach([&](std::int32_t column, std::int32_t row, const Tiles::Tile& tile) {
    for (std::size_t i = 0; i < tile.size(); ++i) {
      SurfaceBins bins = tile[i].bins;
      while (!bins.empty() && bins.back().height_cm >= ceiling_cm) {
        statistics.tooShallow += bins.back().count;
        bins.pop_back();
      }
      if (bins.empty()) continue;
      Cell cell;
      cell.column = column + static_cast<std::int32_t>(i % Tiles::kSide);
      cell.row = row + static_cast<std::int32_t>(i / Tiles::kSide);
      switch (estimate(std::move(bins), tile[i].pings, options_, cell)) {
        case Verdict::Seabed:
          visit(cell);
          break;
        case Verdict::FewPoints:
          ++statistics.fewPoints;
          break;
        case Verdict::Wall:
          ++statistics.walls;
          break;
      }
    }
  });
  return statistics;
}

std::size_t SurfaceEstimator::tilesInMemory() const { return tiles_->inMemory(); }
std::size_t SurfaceEstimator::tileCount() const { return tiles_->count(); }

}  // namespace s2s::map
