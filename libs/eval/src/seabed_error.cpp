#include "s2s/eval/seabed_error.h"

#include <cmath>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace s2s::eval {

namespace {

/// Mean height of the true surface over a cell, by rays on a regular pattern inside it; rays that hit nothing are left
/// out. The pattern turns with the map's axes, as the cell does.
std::optional<double> meanTrueHeight(const MeshQuery& seabed, const core::Isometry& T_world_map,
                                     const Eigen::Vector3d& centre_map, double cell_m, int raysPerSide) {
  double sum = 0;
  int hits = 0;
  for (int i = 0; i < raysPerSide; ++i)
    for (int k = 0; k < raysPerSide; ++k) {
      const Eigen::Vector3d offset(((i + 0.5) / raysPerSide - 0.5) * cell_m, ((k + 0.5) / raysPerSide - 0.5) * cell_m,
                                   0);
      const Eigen::Vector3d p_world = T_world_map * (centre_map + offset);
      if (const auto height_m = seabed.topHeight_m(p_world.x(), p_world.y())) {
        sum += *height_m;
        ++hits;
      }
    }
  if (hits == 0) return std::nullopt;
  return sum / hits;
}

/// Sums over cells on the way to a SeabedError.
struct Tally {
  std::vector<double> errors_m;
  std::array<std::size_t, kHydrographicOrders.size()> withinOrder{};
  std::size_t withSigma = 0, withinTwoSigma = 0;
  double depths_m = 0;

  void add(double error_m, double depth_m, double sigma_m) {
    errors_m.push_back(error_m);
    depths_m += depth_m;
    for (std::size_t i = 0; i < kHydrographicOrders.size(); ++i)
      if (std::abs(error_m) <= totalVerticalUncertainty_m(kHydrographicOrders[i], depth_m)) ++withinOrder[i];
    if (!std::isfinite(sigma_m) || sigma_m <= 0) return;
    ++withSigma;
    if (std::abs(error_m) <= 2 * sigma_m) ++withinTwoSigma;
  }

  void fill(SeabedError& result) const {
    result.cells = errors_m.size();
    if (errors_m.empty()) return;
    const auto n = static_cast<double>(errors_m.size());
    std::vector<double> magnitudes;
    for (const double e : errors_m) magnitudes.push_back(std::abs(e));
    const Summary plain = summarise(errors_m), absolute = summarise(std::move(magnitudes));
    result.bias_m = plain.mean;
    result.rmse_m = plain.rmse;
    result.std_m = plain.std;
    result.p95_m = absolute.p95;
    result.max_m = absolute.max;
    for (std::size_t i = 0; i < withinOrder.size(); ++i)
      result.withinOrder[i] = static_cast<double>(withinOrder[i]) / n;
    result.withinTwoSigma = withSigma > 0 ? static_cast<double>(withinTwoSigma) / static_cast<double>(withSigma) : 0;
    result.meanDepth_m = depths_m / n;
  }
};

/// Counts the true seabed within a radius of the path on a regular grid of the world, and how much of it the map has.
void measureCoverage(const products::HeightGrid& grid, const core::Isometry& T_world_map, const MeshQuery& seabed,
                     const core::Trajectory& trajectory, double radius_m, SeabedError& result) {
  const double cell_m = grid.cell_m;
  const int reach = static_cast<int>(std::ceil(radius_m / cell_m));
  std::set<std::pair<int, int>> near;
  Eigen::Vector2d last(1e12, 1e12);
  for (const auto& pose : trajectory.poses()) {
    const Eigen::Vector2d p = pose.T.translation().head<2>();
    if ((p - last).norm() < cell_m) continue;  // a place nearer than a cell to the last adds next to nothing
    last = p;
    const int column = static_cast<int>(std::floor(p.x() / cell_m)), row = static_cast<int>(std::floor(p.y() / cell_m));
    for (int i = -reach; i <= reach; ++i)
      for (int k = -reach; k <= reach; ++k) {
        const Eigen::Vector2d centre((column + i + 0.5) * cell_m, (row + k + 0.5) * cell_m);
        if ((centre - p).norm() <= radius_m) near.emplace(column + i, row + k);
      }
  }
  const core::Isometry T_map_world = T_world_map.inverse();
  std::size_t covered = 0;
  for (const auto& [column, row] : near) {
    const double x = (column + 0.5) * cell_m, y = (row + 0.5) * cell_m;
    const auto height_m = seabed.topHeight_m(x, y);
    if (!height_m) continue;
    ++result.trueCells;
    const Eigen::Vector3d p_map = T_map_world * Eigen::Vector3d(x, y, *height_m);
    if (grid.heightAt(p_map.x(), p_map.y())) ++covered;
  }
  if (result.trueCells > 0) result.coverage = static_cast<double>(covered) / static_cast<double>(result.trueCells);
}

}  // namespace

SeabedError compareSeabed(const products::HeightGrid& grid, const core::Isometry& T_world_map, const MeshQuery& seabed,
                          const core::Trajectory& trajectory_world, const SeabedErrorOptions& options) {
  SeabedError result;
  Tally tally;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      if (!grid.hasValue(column, row)) continue;
      const Eigen::Vector2d centre = grid.centre(column, row);
      const double height_m = grid.height_m[grid.index(column, row)];
      const Eigen::Vector3d p_map(centre.x(), centre.y(), height_m);
      const auto truth_m = meanTrueHeight(seabed, T_world_map, p_map, grid.cell_m, options.raysPerSide);
      if (!truth_m)
        ++result.withoutTruth;
      else
        tally.add((T_world_map * p_map).z() - *truth_m, -*truth_m, grid.sigma_m[grid.index(column, row)]);
    }
  tally.fill(result);
  measureCoverage(grid, T_world_map, seabed, trajectory_world, options.coverageRadius_m, result);
  return result;
}

}  // namespace s2s::eval
