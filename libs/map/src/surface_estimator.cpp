#include "s2s/map/surface_estimator.h"

#include <algorithm>
#include <cmath>

#include "surface_tiles.h"

namespace s2s::map {

namespace {

constexpr double kLargestIndex = 1e9;  // cell and bin indices beyond are not coordinates of a survey

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
  const SurfaceMiddle middle = middleOf(bins, pings);
  cell.height_m = middle.value_m;
  cell.sigma_m = middle.sigma_m;
  return Verdict::Seabed;
}

}  // namespace

SurfaceEstimator::SurfaceEstimator(const SurfaceOptions& options) : options_(options) { clear(); }
SurfaceEstimator::~SurfaceEstimator() = default;
SurfaceEstimator::SurfaceEstimator(SurfaceEstimator&&) noexcept = default;
SurfaceEstimator& SurfaceEstimator::operator=(SurfaceEstimator&&) noexcept = default;

void SurfaceEstimator::clear() {
  tiles_ = std::make_unique<SurfaceTiles>(static_cast<std::size_t>(std::max(1, options_.maxTilesInMemory)));
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
  enterValue(column, point.p_map.z(), sigma_m, point.time, sign);
}

SurfaceStatistics SurfaceEstimator::forEachCell(double waterHeight_m,
                                                const std::function<void(const Cell&)>& visit) const {
  SurfaceStatistics statistics;
  statistics.soundings = soundings_ + notFinite_;
  statistics.notFinite = notFinite_;
  const double ceiling_cm = (waterHeight_m - options_.minDepth_m) * kBinsPerMetre;
  tiles_->forEach([&](std::int32_t column, std::int32_t row, const SurfaceTiles::Tile& tile) {
    for (std::size_t i = 0; i < tile.size(); ++i) {
      SurfaceBins bins = tile[i].bins;
      while (!bins.empty() && bins.back().height_cm >= ceiling_cm) {
        statistics.tooShallow += bins.back().count;
        bins.pop_back();
      }
      if (bins.empty()) continue;
      Cell cell;
      cell.column = column + static_cast<std::int32_t>(i % SurfaceTiles::kSide);
      cell.row = row + static_cast<std::int32_t>(i / SurfaceTiles::kSide);
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
