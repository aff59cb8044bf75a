#include "s2s/products/seabed_gridder.h"

#include <algorithm>
#include <limits>

#include "s2s/core/error.h"

namespace s2s::products {

namespace {

constexpr double kBinsPerMetre = 100;
constexpr double kMadToSigma = 1.4826;  // of a normal distribution
constexpr double kLargestIndex = 1e9;   // cell and bin indices beyond are not coordinates of a survey
constexpr int kNeighbourReach = 2;      // 5 x 5 cells
constexpr std::size_t kMinNeighbours = 4;

std::uint64_t cellKey(std::int32_t column, std::int32_t row) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(column)) << 32 | static_cast<std::uint32_t>(row);
}
std::int32_t columnOf(std::uint64_t key) { return static_cast<std::int32_t>(key >> 32); }
std::int32_t rowOf(std::uint64_t key) { return static_cast<std::int32_t>(key & 0xffffffffU); }

template <class BinList>
double totalWeight(const BinList& bins) {
  double sum = 0;
  for (const auto& bin : bins) sum += bin.weight;
  return sum;
}

/// Index of the bin in which the cumulative weight passes the share `quantile`.
template <class BinList>
std::size_t quantileBin(const BinList& bins, double quantile) {
  const double target = quantile * totalWeight(bins);
  double sum = 0;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    sum += bins[i].weight;
    if (sum >= target) return i;
  }
  return bins.size() - 1;
}

/// Weighted median of the absolute deviations of the bins' mean heights.
template <class BinList>
double medianDeviation(const BinList& bins, double centre) {
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

}  // namespace

SeabedGridder::SeabedGridder(const SeabedGridOptions& options, double waterHeight_m)
    : options_(options), ceiling_m_(waterHeight_m - options.minDepth_m) {}

void SeabedGridder::add(const map::MapPoint& point) {
  if (point.layer == map::Layer::Lidar || point.isWall) return;
  ++statistics_.soundings;
  const Eigen::Vector3d cellAndBin(point.p_map.x() / options_.cell_m, point.p_map.y() / options_.cell_m,
                                   point.p_map.z() * kBinsPerMetre);
  // NaN fails the comparison too; maxCoeff() would pass over it.
  if (!(cellAndBin.array().abs() < kLargestIndex).all() || !std::isfinite(point.sigma_m)) {
    ++statistics_.notFinite;
    return;
  }
  if (point.p_map.z() > ceiling_m_) {
    ++statistics_.tooShallow;
    return;
  }
  const double sigma = std::max(static_cast<double>(point.sigma_m), options_.sigmaFloor_m);
  const double weight = 1 / (sigma * sigma);
  const int height_cm = static_cast<int>(std::floor(cellAndBin.z()));
  Cell& cell = cells_[cellKey(static_cast<std::int32_t>(std::floor(cellAndBin.x())),
                              static_cast<std::int32_t>(std::floor(cellAndBin.y())))];
  if (cell.pings == 0 || cell.lastTime != point.time) ++cell.pings;
  cell.lastTime = point.time;
  auto bin = std::lower_bound(cell.bins.begin(), cell.bins.end(), height_cm,
                              [](const Bin& b, int height) { return b.height_cm < height; });
  if (bin == cell.bins.end() || bin->height_cm != height_cm) bin = cell.bins.insert(bin, Bin{height_cm});
  ++bin->count;
  bin->weight += weight;
  bin->weightedHeight += weight * point.p_map.z();
}

SeabedGridder::Bins SeabedGridder::seabedLayer(const Bins& cell) const {
  const int window_cm = static_cast<int>(std::lround(options_.window_m * kBinsPerMetre));
  // Weight of the layer that begins at each bin, by two running indices.
  std::vector<double> layerWeight(cell.size());
  std::size_t end = 0;
  double sum = 0;
  for (std::size_t begin = 0; begin < cell.size(); ++begin) {
    while (end < cell.size() && cell[end].height_cm < cell[begin].height_cm + window_cm) sum += cell[end++].weight;
    layerWeight[begin] = sum;
    sum -= cell[begin].weight;
  }
  const double heaviest = *std::max_element(layerWeight.begin(), layerWeight.end());
  std::size_t lowest = 0;
  while (layerWeight[lowest] < 0.5 * heaviest) ++lowest;
  // Upwards while it grows heavier, at most to twice its height: the layer is to hold the whole of the seabed's
  // scatter.
  std::size_t best = lowest;
  for (std::size_t i = lowest; i < cell.size() && cell[i].height_cm < cell[lowest].height_cm + window_cm; ++i)
    if (layerWeight[i] > layerWeight[best]) best = i;
  Bins layer;
  for (std::size_t i = best; i < cell.size() && cell[i].height_cm < cell[best].height_cm + window_cm; ++i)
    layer.push_back(cell[i]);
  return layer;
}

SeabedGridder::Verdict SeabedGridder::estimate(const Cell& cell, Estimate& result) const {
  const auto countOf = [](const Bins& bins) {
    std::uint32_t sum = 0;
    for (const auto& bin : bins) sum += bin.count;
    return sum;
  };
  if (countOf(cell.bins) < static_cast<std::uint32_t>(options_.minPoints)) return Verdict::FewPoints;
  const int spread_cm =
      cell.bins[quantileBin(cell.bins, 0.95)].height_cm - cell.bins[quantileBin(cell.bins, 0.05)].height_cm;
  Bins layer = cell.bins;
  if (spread_cm > options_.flatSpread_m * kBinsPerMetre) {
    layer = seabedLayer(cell.bins);
    result.doubtful = true;
    if (totalWeight(layer) < options_.minSeabedShare * totalWeight(cell.bins)) return Verdict::Wall;
  }
  result.count = countOf(layer);
  if (result.count < static_cast<std::uint32_t>(options_.minPoints)) return Verdict::FewPoints;
  const Bin& middle = layer[quantileBin(layer, 0.5)];
  result.height_m = middle.weightedHeight / middle.weight;
  const double scatter_m = kMadToSigma * medianDeviation(layer, result.height_m);
  const double claimed = result.count / totalWeight(layer), pings = cell.pings;
  result.sigma_m = std::sqrt((claimed + pings * scatter_m * scatter_m) / (1 + pings));
  return Verdict::Seabed;
}

HeightGrid SeabedGridder::grid() {
  statistics_.cells = statistics_.fewPoints = statistics_.walls = statistics_.steps = 0;
  std::vector<std::pair<std::uint64_t, Estimate>> estimates;
  for (const auto& [key, cell] : cells_) {
    Estimate result;
    const Verdict verdict = estimate(cell, result);
    if (verdict == Verdict::Seabed) estimates.emplace_back(key, result);
    if (verdict == Verdict::FewPoints) ++statistics_.fewPoints;
    if (verdict == Verdict::Wall) ++statistics_.walls;
  }
  if (estimates.empty()) return HeightGrid(0, 0, options_.cell_m, 0, 0);
  std::int64_t minColumn = columnOf(estimates[0].first), maxColumn = minColumn;
  std::int64_t minRow = rowOf(estimates[0].first), maxRow = minRow;
  for (const auto& [key, result] : estimates) {
    minColumn = std::min<std::int64_t>(minColumn, columnOf(key));
    maxColumn = std::max<std::int64_t>(maxColumn, columnOf(key));
    minRow = std::min<std::int64_t>(minRow, rowOf(key));
    maxRow = std::max<std::int64_t>(maxRow, rowOf(key));
  }
  const std::int64_t columns = maxColumn - minColumn + 1, rows = maxRow - minRow + 1;
  if (static_cast<double>(columns) * static_cast<double>(rows) > options_.maxCells)
    throw core::OutputError(
        "the seabed grid would have " + std::to_string(columns) + " x " + std::to_string(rows) + " cells",
        "seabed grid", "choose a larger cell, or look for sonar points far away from the survey");
  HeightGrid grid(static_cast<double>(minColumn) * options_.cell_m, static_cast<double>(minRow) * options_.cell_m,
                  options_.cell_m, static_cast<int>(columns), static_cast<int>(rows));
  std::vector<bool> doubtful(grid.height_m.size(), false);
  for (const auto& [key, result] : estimates) {
    const std::size_t at =
        grid.index(static_cast<int>(columnOf(key) - minColumn), static_cast<int>(rowOf(key) - minRow));
    grid.height_m[at] = static_cast<float>(result.height_m);
    grid.sigma_m[at] = static_cast<float>(result.sigma_m);
    grid.count[at] = result.count;
    doubtful[at] = result.doubtful;
  }
  removeSteps(grid, doubtful);
  return grid;
}

void SeabedGridder::removeSteps(HeightGrid& grid, const std::vector<bool>& doubtful) {
  constexpr float kEmpty = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> before = grid.height_m;
  double minHeight = std::numeric_limits<double>::infinity(), maxHeight = -minHeight;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const std::size_t at = grid.index(column, row);
      if (std::isnan(before[at])) continue;
      std::vector<float> neighbours;
      for (int dr = -kNeighbourReach; dr <= kNeighbourReach; ++dr)
        for (int dc = -kNeighbourReach; dc <= kNeighbourReach; ++dc)
          if ((dr != 0 || dc != 0) && grid.inside(column + dc, row + dr) &&
              !std::isnan(before[grid.index(column + dc, row + dr)]))
            neighbours.push_back(before[grid.index(column + dc, row + dr)]);
      if (neighbours.size() >= kMinNeighbours) {
        const auto middle = neighbours.begin() + static_cast<std::ptrdiff_t>(neighbours.size() / 2);
        std::nth_element(neighbours.begin(), middle, neighbours.end());
        const double limit_m = doubtful[at] ? options_.maxDoubtfulStep_m : options_.maxStep_m;
        if (std::abs(before[at] - *middle) > limit_m) {
          grid.height_m[at] = grid.sigma_m[at] = kEmpty;
          grid.count[at] = 0;
          ++statistics_.steps;
          continue;
        }
      }
      ++statistics_.cells;
      minHeight = std::min<double>(minHeight, before[at]);
      maxHeight = std::max<double>(maxHeight, before[at]);
    }
  statistics_.area_m2 = static_cast<double>(statistics_.cells) * options_.cell_m * options_.cell_m;
  statistics_.minHeight_m = statistics_.cells > 0 ? minHeight : 0;
  statistics_.maxHeight_m = statistics_.cells > 0 ? maxHeight : 0;
}

}  // namespace s2s::products
