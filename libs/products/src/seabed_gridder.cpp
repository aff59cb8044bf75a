#include "s2s/products/seabed_gridder.h"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "s2s/core/error.h"

namespace s2s::products {

namespace {

using Cell = map::SurfaceEstimator::Cell;

constexpr int kNeighbourReach = 2;  // 5 x 5 cells
constexpr std::size_t kMinNeighbours = 4;

struct Bounds {
  std::int64_t minColumn, maxColumn, minRow, maxRow;
};

Bounds boundsOf(const std::vector<Cell>& cells) {
  Bounds b{cells[0].column, cells[0].column, cells[0].row, cells[0].row};
  for (const Cell& cell : cells) {
    b.minColumn = std::min<std::int64_t>(b.minColumn, cell.column);
    b.maxColumn = std::max<std::int64_t>(b.maxColumn, cell.column);
    b.minRow = std::min<std::int64_t>(b.minRow, cell.row);
    b.maxRow = std::max<std::int64_t>(b.maxRow, cell.row);
  }
  return b;
}

/// Median of the cells around, if there are enough of them.
std::optional<float> medianAround(const HeightGrid& grid, const std::vector<float>& heights, int column, int row) {
  std::vector<float> neighbours;
  for (int dr = -kNeighbourReach; dr <= kNeighbourReach; ++dr)
    for (int dc = -kNeighbourReach; dc <= kNeighbourReach; ++dc)
      if ((dr != 0 || dc != 0) && grid.inside(column + dc, row + dr) &&
          !std::isnan(heights[grid.index(column + dc, row + dr)]))
        neighbours.push_back(heights[grid.index(column + dc, row + dr)]);
  if (neighbours.size() < kMinNeighbours) return std::nullopt;
  const auto middle = neighbours.begin() + static_cast<std::ptrdiff_t>(neighbours.size() / 2);
  std::nth_element(neighbours.begin(), middle, neighbours.end());
  return *middle;
}

void removeSteps(HeightGrid& grid, const std::vector<bool>& doubtful, const SeabedGridOptions& options,
                 SeabedGridStatistics& statistics) {
  constexpr float kEmpty = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> before = grid.height_m;
  double minHeight = std::numeric_limits<double>::infinity(), maxHeight = -minHeight;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const std::size_t at = grid.index(column, row);
      if (std::isnan(before[at])) continue;
      const auto middle = medianAround(grid, before, column, row);
      const double limit_m = doubtful[at] ? options.maxDoubtfulStep_m : options.maxStep_m;
      if (middle && std::abs(before[at] - *middle) > limit_m) {
        grid.height_m[at] = grid.sigma_m[at] = kEmpty;
        grid.count[at] = 0;
        ++statistics.steps;
        continue;
      }
      ++statistics.cells;
      minHeight = std::min<double>(minHeight, before[at]);
      maxHeight = std::max<double>(maxHeight, before[at]);
    }
  statistics.area_m2 = static_cast<double>(statistics.cells) * grid.cell_m * grid.cell_m;
  statistics.minHeight_m = statistics.cells > 0 ? minHeight : 0;
  statistics.maxHeight_m = statistics.cells > 0 ? maxHeight : 0;
}

}  // namespace

HeightGrid gridOf(const map::SurfaceEstimator& surface, double waterHeight_m, const SeabedGridOptions& options,
                  SeabedGridStatistics* statistics) {
  const double cell_m = surface.options().cell_m;
  SeabedGridStatistics counts;
  std::vector<Cell> cells;
  static_cast<map::SurfaceStatistics&>(counts) =
      surface.forEachCell(waterHeight_m, [&cells](const Cell& cell) { cells.push_back(cell); });
  if (statistics) *statistics = counts;
  if (cells.empty()) return HeightGrid(0, 0, cell_m, 0, 0);
  const Bounds b = boundsOf(cells);
  const std::int64_t columns = b.maxColumn - b.minColumn + 1, rows = b.maxRow - b.minRow + 1;
  if (static_cast<double>(columns) * static_cast<double>(rows) > options.maxCells)
    throw core::OutputError(
        "the seabed grid would have " + std::to_string(columns) + " x " + std::to_string(rows) + " cells",
        "seabed grid", "choose a larger cell, or look for sonar points far away from the survey");
  HeightGrid grid(static_cast<double>(b.minColumn) * cell_m, static_cast<double>(b.minRow) * cell_m, cell_m,
                  static_cast<int>(columns), static_cast<int>(rows));
  std::vector<bool> doubtful(grid.height_m.size(), false);
  for (const Cell& cell : cells) {
    const std::size_t at =
        grid.index(static_cast<int>(cell.column - b.minColumn), static_cast<int>(cell.row - b.minRow));
    grid.height_m[at] = static_cast<float>(cell.height_m);
    grid.sigma_m[at] = static_cast<float>(cell.sigma_m);
    grid.count[at] = cell.count;
    doubtful[at] = cell.doubtful;
  }
  removeSteps(grid, doubtful, options, counts);
  if (statistics) *statistics = counts;
  return grid;
}

}  // namespace s2s::products
