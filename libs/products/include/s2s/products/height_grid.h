#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace s2s::products {

/// A seabed grid in the map frame. Row 0 is the southernmost (smallest y), column 0 the westernmost (smallest x).
/// Heights grow upwards; a cell without a value holds NaN in `height_m` and `sigma_m`, and 0 in `count`.
struct HeightGrid {
  double west_m = 0;   ///< x of the west edge of column 0
  double south_m = 0;  ///< y of the south edge of row 0
  double cell_m = 0.5;
  int columns = 0;
  int rows = 0;
  std::vector<float> height_m;
  std::vector<float> sigma_m;        ///< standard deviation of the height
  std::vector<std::uint32_t> count;  ///< soundings in the cell that speak of the seabed

  HeightGrid() = default;
  /// An empty grid of that shape.
  HeightGrid(double west, double south, double cell, int columnCount, int rowCount)
      : west_m(west), south_m(south), cell_m(cell), columns(columnCount), rows(rowCount) {
    const std::size_t cells = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    height_m.assign(cells, std::numeric_limits<float>::quiet_NaN());
    sigma_m.assign(cells, std::numeric_limits<float>::quiet_NaN());
    count.assign(cells, 0);
  }

  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
  }
  bool inside(int column, int row) const { return column >= 0 && row >= 0 && column < columns && row < rows; }
  bool hasValue(int column, int row) const { return !std::isnan(height_m[index(column, row)]); }
  /// The middle of a cell in the map frame.
  Eigen::Vector2d centre(int column, int row) const {
    return {west_m + (column + 0.5) * cell_m, south_m + (row + 0.5) * cell_m};
  }
  /// Height of the cell that a place lies in; nothing outside or where the cell is empty.
  std::optional<double> heightAt(double x, double y) const {
    const int column = static_cast<int>(std::floor((x - west_m) / cell_m));
    const int row = static_cast<int>(std::floor((y - south_m) / cell_m));
    if (!inside(column, row) || !hasValue(column, row)) return std::nullopt;
    return static_cast<double>(height_m[index(column, row)]);
  }
};

}  // namespace s2s::products
