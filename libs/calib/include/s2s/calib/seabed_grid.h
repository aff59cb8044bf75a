#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

namespace s2s::calib {

/// Heights of the seabed at the corners of square cells, bilinear in between; only where there are data.
class SeabedGrid {
 public:
  /// Indices of a cell or of a node (the cell's lower corner).
  struct Index {
    std::int32_t x = 0, y = 0;
  };

  explicit SeabedGrid(double cell_m) : cell_m_(cell_m) {}

  double cell_m() const { return cell_m_; }
  Index cellOf(double x_m, double y_m) const;
  Eigen::Vector2d corner_m(const Index& cell) const { return {cell.x * cell_m_, cell.y * cell_m_}; }

  /// Starts anew from points: every cell with at least `minCount` of them gets nodes, at the median height of the cells
  /// around. What an earlier grid knew stays for nodes that remain.
  void fit(const std::vector<Eigen::Vector3d>& points_map, int minCount);

  /// Height and slope at a place; nothing outside.
  struct Surface {
    double height_m = 0;
    Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  };
  std::optional<Surface> at(double x_m, double y_m) const;

  /// The four corners (lower left, lower right, upper left, upper right) of a cell that has them all, else null.
  std::array<double*, 4> corners(const Index& cell);
  /// The node nearest to a place, if there is one at that corner.
  double* nearestNode(double x_m, double y_m);
  /// Runs of three nodes along x or y.
  std::vector<std::array<double*, 3>> triples();
  /// All heights, in the order in which nodes were made.
  std::vector<double*> nodes();

 private:
  static std::int64_t key(std::int32_t x, std::int32_t y) {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32 |
                                     static_cast<std::uint32_t>(y));
  }
  const double* node(std::int32_t x, std::int32_t y) const;
  double* node(std::int32_t x, std::int32_t y);

  double cell_m_;
  std::deque<double> heights_;  // stable addresses
  std::vector<Index> places_;
  std::unordered_map<std::int64_t, std::size_t> index_;
};

}  // namespace s2s::calib
