#include "s2s/map/surface_evidence.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace s2s::map {

namespace {

/// A slab of a column needs this many points to be believed: a stray echo below the seabed must not move it.
constexpr float kMinSeabedPoints = 3;
/// And this share of the points of the fullest slab: late echoes, which are put too low, go on coming as pings do.
constexpr float kMinSeabedShare = 0.2f;
/// Cosine of the angle between cells of one wall: 15 degrees.
constexpr double kSameWallCosine = 0.966;
/// A slab of a wall cell needs this many before its shape says anything; it is looked at again after as many more.
constexpr int kMinSlabPoints = 4;

/// The entry of a sorted vector with this bin, made if missing.
template <class Binned>
Binned& entryOf(std::vector<Binned>& entries, int bin) {
  auto place = std::lower_bound(entries.begin(), entries.end(), bin,
                                [](const Binned& entry, int wanted) { return entry.bin < wanted; });
  if (place == entries.end() || place->bin != bin) {
    place = entries.insert(place, Binned());
    place->bin = bin;
  }
  return *place;
}

struct LineFit {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();
  double thickness_m = 0;  ///< standard deviation across the line
};

template <class Moments>
LineFit fitLine(const Moments& m) {
  LineFit fit;
  const double n = m.count;
  fit.centre = Eigen::Vector2d(m.x / n, m.y / n);
  Eigen::Matrix2d covariance;
  covariance << m.xx / n, m.xy / n, m.xy / n, m.yy / n;
  covariance -= fit.centre * fit.centre.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
  solver.computeDirect(covariance);
  fit.normal = solver.eigenvectors().col(0);
  fit.thickness_m = std::sqrt(std::max(0.0, solver.eigenvalues()[0]));
  return fit;
}

}  // namespace

void SurfaceEvidence::reset(const ResolverOptions& options) {
  options_ = options;
  seabed_ = SparseGrid<Column>(options.cell_m);
  walls_ = SparseGrid<WallCell>(options.wallCell_m);
  wallCount_ = 0;
}

void SurfaceEvidence::addSeabedPoint(const Eigen::Vector3d& p_map, double sigma_m) {
  Column& column = seabed_.at(seabed_.index(p_map.x()), seabed_.index(p_map.y()));
  const int bin = static_cast<int>(std::floor(p_map.z() / options_.cell_m));
  Slab& slab = entryOf(column.slabs, bin);
  // Heights are summed from the slab's lower face: single precision then keeps them to a tenth of a millimetre.
  const auto dz = static_cast<float>(p_map.z() - bin * options_.cell_m);
  const auto weight = static_cast<float>(1.0 / std::max(1e-6, sigma_m * sigma_m));
  slab.count += 1;
  slab.weight += weight;
  slab.weightedZ += weight * dz;
  slab.weightedZZ += weight * dz * dz;
  updateSeabed(column);
}

/// The seabed of a column is its lowest slab with enough points, and the one above it, which holds the other half of a
/// seabed that lies on the face between the two.
void SurfaceEvidence::updateSeabed(Column& column) const {
  const double cell_m = options_.cell_m;
  float fullest = 0;
  for (const Slab& slab : column.slabs) fullest = std::max(fullest, slab.count);
  for (std::size_t i = 0; i < column.slabs.size(); ++i) {
    const Slab& low = column.slabs[i];
    if (low.count < std::max(kMinSeabedPoints, kMinSeabedShare * fullest)) continue;
    double count = low.count, weight = low.weight, z = low.weightedZ, zz = low.weightedZZ;
    if (i + 1 < column.slabs.size() && column.slabs[i + 1].bin == low.bin + 1) {
      const Slab& high = column.slabs[i + 1];
      count += high.count;
      weight += high.weight;
      z += high.weightedZ + high.weight * cell_m;
      zz += high.weightedZZ + 2 * high.weightedZ * cell_m + high.weight * cell_m * cell_m;
    }
    const double mean = z / weight;
    const double spread2 = std::max(0.0, zz / weight - mean * mean);
    column.height_m = static_cast<float>(low.bin * cell_m + mean);
    // Points of one ping share its errors, so neither the spread nor the points' own variance is divided by their
    // number.
    column.sigma_m = static_cast<float>(std::sqrt(std::max(spread2, count / weight)));
    return;
  }
}

void SurfaceEvidence::addWallPoint(const Eigen::Vector3d& p_map) {
  const std::int32_t ix = walls_.index(p_map.x()), iy = walls_.index(p_map.y());
  WallCell& cell = walls_.at(ix, iy);
  const Eigen::Vector2d corner_m(ix * options_.wallCell_m, iy * options_.wallCell_m);
  Moments& m = entryOf(cell.moments, static_cast<int>(std::floor(p_map.z() / options_.wallCell_m)));
  const auto x = static_cast<float>(p_map.x() - corner_m.x()), y = static_cast<float>(p_map.y() - corner_m.y());
  const auto z = static_cast<float>(p_map.z());
  m.bottom_m = m.count == 0 ? z : std::min(m.bottom_m, z);
  m.top_m = m.count == 0 ? z : std::max(m.top_m, z);
  m.count += 1;
  m.x += x;
  m.y += y;
  m.xx += x * x;
  m.xy += x * y;
  m.yy += y * y;
  if (static_cast<int>(m.count) % kMinSlabPoints == 0) updateWall(cell, corner_m);
}

/// A wall is what its slabs have in common that are thin in plan: a slab of seabed fills the cell and is left out.
void SurfaceEvidence::updateWall(WallCell& cell, const Eigen::Vector2d& corner_m) {
  Moments sum;
  bool first = true;
  for (const Moments& m : cell.moments) {
    if (m.count < static_cast<float>(kMinSlabPoints) || fitLine(m).thickness_m > options_.wallMaxThickness_m) continue;
    sum.bottom_m = first ? m.bottom_m : std::min(sum.bottom_m, m.bottom_m);
    sum.top_m = first ? m.top_m : std::max(sum.top_m, m.top_m);
    first = false;
    sum.count += m.count;
    sum.x += m.x;
    sum.y += m.y;
    sum.xx += m.xx;
    sum.xy += m.xy;
    sum.yy += m.yy;
  }
  const bool was = cell.isWall;
  cell.isWall = false;
  if (static_cast<int>(sum.count) >= options_.wallMinPoints && sum.top_m - sum.bottom_m >= options_.wallMinHeight_m) {
    const LineFit fit = fitLine(sum);
    cell.isWall = fit.thickness_m <= options_.wallMaxThickness_m;
    cell.wall = {fit.normal, fit.normal.dot(fit.centre + corner_m), fit.thickness_m, sum.top_m};
  }
  wallCount_ += (cell.isWall ? 1u : 0u) - (was ? 1u : 0u);
}

std::optional<SurfaceEvidence::Seabed> SurfaceEvidence::seabedAt(double x_m, double y_m) const {
  // Cell centres are at half indices: shift by half a cell to find the four around.
  const double u = x_m / options_.cell_m - 0.5, v = y_m / options_.cell_m - 0.5;
  const auto ix = static_cast<std::int32_t>(std::floor(u)), iy = static_cast<std::int32_t>(std::floor(v));
  const double fu = u - ix, fv = v - iy;
  SparseGrid<Column>::Hint hint;
  double weight = 0, height = 0, variance = 0;
  for (int dx = 0; dx < 2; ++dx)
    for (int dy = 0; dy < 2; ++dy) {
      const Column* column = seabed_.find(ix + dx, iy + dy, hint);
      if (!column || column->sigma_m < 0) continue;
      // The small addition lets a cell speak for its border where its neighbours know nothing.
      const double w = (dx ? fu : 1 - fu) * (dy ? fv : 1 - fv) + 1e-3;
      weight += w;
      height += w * column->height_m;
      variance += w * column->sigma_m * column->sigma_m;
    }
  if (weight == 0) return std::nullopt;
  return Seabed{height / weight, std::sqrt(variance / weight)};
}

std::optional<SurfaceEvidence::Wall> SurfaceEvidence::wallNear(double x_m, double y_m) const {
  if (wallCount_ == 0) return std::nullopt;
  const std::int32_t ix = walls_.index(x_m), iy = walls_.index(y_m);
  const Eigen::Vector2d place_m(x_m, y_m);
  SparseGrid<WallCell>::Hint hint;
  std::array<const Wall*, 9> around{};
  std::size_t count = 0;
  const Wall* nearest = nullptr;
  const auto distance = [&](const Wall& wall) { return wall.normal.dot(place_m) - wall.offset_m; };
  for (int dx = -1; dx <= 1; ++dx)
    for (int dy = -1; dy <= 1; ++dy) {
      const WallCell* cell = walls_.find(ix + dx, iy + dy, hint);
      if (!cell || !cell->isWall) continue;
      around[count++] = &cell->wall;
      if (!nearest || std::abs(distance(cell->wall)) < std::abs(distance(*nearest))) nearest = &cell->wall;
    }
  if (!nearest) return std::nullopt;
  // One cell's plane is uncertain, and the nearest of several is near by chance as well: the mean of those that agree.
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();
  double sum_m = 0, top_m = nearest->top_m, agreeing = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double cosine = around[i]->normal.dot(nearest->normal), sign = cosine < 0 ? -1 : 1;
    const double there_m = sign * distance(*around[i]);
    if (std::abs(cosine) < kSameWallCosine || std::abs(there_m - distance(*nearest)) > options_.wallMaxThickness_m)
      continue;
    normal += sign * around[i]->normal;
    sum_m += there_m;
    top_m = std::max(top_m, around[i]->top_m);
    agreeing += 1;
  }
  Wall wall = *nearest;
  wall.normal = normal.normalized();
  wall.offset_m = wall.normal.dot(place_m) - sum_m / agreeing;
  wall.top_m = top_m;
  return wall;
}

}  // namespace s2s::map
