#include "s2s/calib/seabed_grid.h"

#include <algorithm>
#include <cmath>

namespace s2s::calib {

namespace {

double median(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

SeabedGrid::Index SeabedGrid::cellOf(double x_m, double y_m) const {
  return {static_cast<std::int32_t>(std::floor(x_m / cell_m_)), static_cast<std::int32_t>(std::floor(y_m / cell_m_))};
}

const double* SeabedGrid::node(std::int32_t x, std::int32_t y) const {
  const auto found = index_.find(key(x, y));
  return found == index_.end() ? nullptr : &heights_[found->second];
}

double* SeabedGrid::node(std::int32_t x, std::int32_t y) {
  const auto found = index_.find(key(x, y));
  return found == index_.end() ? nullptr : &heights_[found->second];
}

void SeabedGrid::fit(const std::vector<Eigen::Vector3d>& points_map, int minCount) {
  const SeabedGrid old = *this;
  std::unordered_map<std::int64_t, std::pair<Index, std::vector<float>>> cells;
  for (const auto& p : points_map) {
    const Index cell = cellOf(p.x(), p.y());
    auto& entry = cells[key(cell.x, cell.y)];
    entry.first = cell;
    entry.second.push_back(static_cast<float>(p.z()));
  }
  heights_.clear();
  places_.clear();
  index_.clear();
  // Sorted, so that the order of nodes depends on the points only.
  std::vector<std::pair<Index, double>> kept;
  for (auto& [unused, entry] : cells)
    if (static_cast<int>(entry.second.size()) >= minCount) kept.emplace_back(entry.first, median(entry.second));
  std::sort(kept.begin(), kept.end(), [](const auto& a, const auto& b) {
    return std::pair(a.first.x, a.first.y) < std::pair(b.first.x, b.first.y);
  });
  std::vector<std::pair<double, int>> sums;  // of the cells around a node
  for (const auto& [cell, height_m] : kept)
    for (const auto& [dx, dy] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
      const auto [found, isNew] = index_.try_emplace(key(cell.x + dx, cell.y + dy), heights_.size());
      if (isNew) {
        heights_.push_back(0);
        places_.push_back({cell.x + dx, cell.y + dy});
        sums.emplace_back(0, 0);
      }
      sums[found->second].first += height_m;
      ++sums[found->second].second;
    }
  for (std::size_t n = 0; n < heights_.size(); ++n) {
    const double* before = old.node(places_[n].x, places_[n].y);
    heights_[n] = before ? *before : sums[n].first / sums[n].second;
  }
}

std::optional<SeabedGrid::Surface> SeabedGrid::at(double x_m, double y_m) const {
  const Index cell = cellOf(x_m, y_m);
  const double *h00 = node(cell.x, cell.y), *h10 = node(cell.x + 1, cell.y), *h01 = node(cell.x, cell.y + 1),
               *h11 = node(cell.x + 1, cell.y + 1);
  if (!h00 || !h10 || !h01 || !h11) return {};
  const double u = x_m / cell_m_ - cell.x, v = y_m / cell_m_ - cell.y;
  Surface surface;
  surface.height_m = (1 - u) * (1 - v) * *h00 + u * (1 - v) * *h10 + (1 - u) * v * *h01 + u * v * *h11;
  surface.slope = {((1 - v) * (*h10 - *h00) + v * (*h11 - *h01)) / cell_m_,
                   ((1 - u) * (*h01 - *h00) + u * (*h11 - *h10)) / cell_m_};
  return surface;
}

std::array<double*, 4> SeabedGrid::corners(const Index& cell) {
  return {node(cell.x, cell.y), node(cell.x + 1, cell.y), node(cell.x, cell.y + 1), node(cell.x + 1, cell.y + 1)};
}

double* SeabedGrid::nearestNode(double x_m, double y_m) {
  return node(static_cast<std::int32_t>(std::lround(x_m / cell_m_)),
              static_cast<std::int32_t>(std::lround(y_m / cell_m_)));
}

std::vector<std::array<double*, 3>> SeabedGrid::triples() {
  std::vector<std::array<double*, 3>> runs;
  for (std::size_t n = 0; n < heights_.size(); ++n) {
    const Index at = places_[n];
    for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}}) {
      double *next = node(at.x + dx, at.y + dy), *afterNext = node(at.x + 2 * dx, at.y + 2 * dy);
      if (next && afterNext) runs.push_back({&heights_[n], next, afterNext});
    }
  }
  return runs;
}

std::vector<double*> SeabedGrid::nodes() {
  std::vector<double*> all;
  all.reserve(heights_.size());
  for (double& height_m : heights_) all.push_back(&height_m);
  return all;
}

}  // namespace s2s::calib
