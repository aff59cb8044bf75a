#include "s2s/sonar/dbscan.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "s2s/core/error.h"

namespace s2s::sonar {

namespace {

/// Points sorted into square cells whose diagonal is just below epsilon; cells within epsilon are at most 2 apart.
class CellGrid {
 public:
  struct Cell {
    std::int64_t key;
    std::int64_t column, row;
    std::size_t begin, end;  // in order()
  };

  CellGrid(const std::vector<Eigen::Vector2d>& points, double epsilon_m) {
    const double side = epsilon_m / std::sqrt(2.0) * (1 - 1e-9);  // the diagonal stays below epsilon when rounded
    Eigen::Vector2d low = points.front(), high = points.front();
    for (const auto& p : points) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    stride_ = static_cast<std::int64_t>(std::floor((high.x() - low.x()) / side)) + 1 + 2 * kReach;
    std::vector<std::int64_t> keys(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector2d u = (points[i] - low) / side;
      keys[i] = static_cast<std::int64_t>(std::floor(u.y())) * stride_ + static_cast<std::int64_t>(std::floor(u.x()));
    }
    order_.resize(points.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) { return keys[a] < keys[b]; });
    cellOf_.resize(points.size());
    for (std::size_t i = 0; i < order_.size(); ++i) {
      const std::int64_t key = keys[order_[i]];
      if (cells_.empty() || cells_.back().key != key) cells_.push_back({key, key % stride_, key / stride_, i, i});
      cells_.back().end = i + 1;
      cellOf_[order_[i]] = cells_.size() - 1;
    }
  }

  const std::vector<Cell>& cells() const { return cells_; }
  const std::vector<std::size_t>& order() const { return order_; }
  std::size_t cellOf(std::size_t point) const { return cellOf_[point]; }

  /// Calls `visit(cellIndex)` for the cells that may hold points within epsilon, the cell itself included, until it
  /// returns false.
  template <class Visit>
  void forNeighbours(std::size_t cell, const Visit& visit) const {
    for (std::int64_t row = -kReach; row <= kReach; ++row) {
      const std::int64_t first = cells_[cell].key + row * stride_ - kReach, last = first + 2 * kReach;
      auto it = std::lower_bound(cells_.begin(), cells_.end(), first,
                                 [](const Cell& c, std::int64_t key) { return c.key < key; });
      for (; it != cells_.end() && it->key <= last; ++it)
        if (!visit(static_cast<std::size_t>(it - cells_.begin()))) return;
    }
  }

 private:
  static constexpr std::int64_t kReach = 2;
  std::int64_t stride_ = 1;
  std::vector<Cell> cells_;
  std::vector<std::size_t> order_, cellOf_;
};

class Clusterer {
 public:
  Clusterer(const std::vector<Eigen::Vector2d>& points, const DbscanOptions& options)
      : points_(points),
        epsilonSquared_(options.epsilon_m * options.epsilon_m),
        minPoints_(static_cast<std::size_t>(options.minPoints)),
        grid_(points, options.epsilon_m) {}

  std::vector<int> run() {
    markCores();
    joinCells();
    return labels();
  }

 private:
  bool near(std::size_t a, std::size_t b) const { return (points_[a] - points_[b]).squaredNorm() <= epsilonSquared_; }

  bool isCore(std::size_t point) const {
    std::size_t count = 0;
    grid_.forNeighbours(grid_.cellOf(point), [&](std::size_t other) {
      const auto& cell = grid_.cells()[other];
      for (std::size_t i = cell.begin; i < cell.end && count < minPoints_; ++i)
        if (near(point, grid_.order()[i])) ++count;
      return count < minPoints_;
    });
    return count >= minPoints_;
  }

  void markCores() {
    core_.assign(points_.size(), 0);
    for (const auto& cell : grid_.cells()) {
      const bool full = cell.end - cell.begin >= minPoints_;
      for (std::size_t i = cell.begin; i < cell.end; ++i)
        core_[grid_.order()[i]] = full || isCore(grid_.order()[i]) ? 1 : 0;
    }
  }

  std::size_t root(std::size_t cell) {
    while (parent_[cell] != cell) cell = parent_[cell] = parent_[parent_[cell]];
    return cell;
  }

  bool haveNearCores(const CellGrid::Cell& a, const CellGrid::Cell& b) const {
    for (std::size_t i = a.begin; i < a.end; ++i) {
      if (core_[grid_.order()[i]] == 0) continue;
      for (std::size_t j = b.begin; j < b.end; ++j)
        if (core_[grid_.order()[j]] != 0 && near(grid_.order()[i], grid_.order()[j])) return true;
    }
    return false;
  }

  /// All core points of a cell are within epsilon of each other, so clusters are sets of cells.
  void joinCells() {
    parent_.resize(grid_.cells().size());
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    for (std::size_t cell = 0; cell < parent_.size(); ++cell)
      grid_.forNeighbours(cell, [&](std::size_t other) {
        if (other <= cell || root(cell) == root(other)) return true;
        if (haveNearCores(grid_.cells()[cell], grid_.cells()[other])) parent_[root(other)] = root(cell);
        return true;
      });
  }

  /// The nearest core point within epsilon, of equally near ones the lowest index; points_.size() if there is none.
  std::size_t nearestCore(std::size_t point) const {
    std::size_t best = points_.size();
    double bestSquared = epsilonSquared_;
    grid_.forNeighbours(grid_.cellOf(point), [&](std::size_t other) {
      const auto& cell = grid_.cells()[other];
      for (std::size_t i = cell.begin; i < cell.end; ++i) {
        const std::size_t candidate = grid_.order()[i];
        if (core_[candidate] == 0) continue;
        const double squared = (points_[point] - points_[candidate]).squaredNorm();
        if (squared > bestSquared || (squared == bestSquared && candidate > best)) continue;
        best = candidate;
        bestSquared = squared;
      }
      return true;
    });
    return best;
  }

  std::vector<int> labels() {
    std::vector<int> ofCell(parent_.size(), kNoise), labels(points_.size(), kNoise);
    int count = 0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (core_[i] == 0) continue;
      int& label = ofCell[root(grid_.cellOf(i))];
      if (label == kNoise) label = count++;
      labels[i] = label;
    }
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (core_[i] != 0) continue;
      const std::size_t core = nearestCore(i);
      if (core < points_.size()) labels[i] = labels[core];
    }
    return labels;
  }

  const std::vector<Eigen::Vector2d>& points_;
  double epsilonSquared_;
  std::size_t minPoints_;
  CellGrid grid_;
  std::vector<char> core_;
  std::vector<std::size_t> parent_;
};

}  // namespace

std::vector<int> dbscan(const std::vector<Eigen::Vector2d>& points, const DbscanOptions& options) {
  if (!(options.epsilon_m > 0) || options.minPoints < 1)
    throw core::ConfigError("DBSCAN needs a positive epsilon and at least 1 point", "sonar DBSCAN",
                            "give e.g. 0.2 m and 20 points");
  if (points.empty()) return {};
  return Clusterer(points, options).run();
}

}  // namespace s2s::sonar
