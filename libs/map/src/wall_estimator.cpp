#include "s2s/map/wall_estimator.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "surface_tiles.h"

namespace s2s::map {

namespace {

/// Directions of walls, all around, since a wall is seen from one side.
constexpr std::int32_t kSectors = 72;
/// Edge of the places at which a wall's direction is settled.
constexpr double kPlace_m = 0.5;
/// Rows of tiles that a sector and a sensor take: heights within +-512 m at the default cell.
constexpr std::int32_t kRows = 4096;
/// Points of one cell further apart are of two walls.
constexpr int kApart_cm = 30;
/// Cells whose faces differ by more are not of one plane.
constexpr double kSamePlane_m = 0.5;

Eigen::Vector2d directionOf(std::int32_t sector) {
  const double azimuth_rad = 2 * M_PI * sector / kSectors;
  return {std::cos(azimuth_rad), std::sin(azimuth_rad)};
}

Eigen::Vector2d alongOf(const Eigen::Vector2d& direction) { return {-direction.y(), direction.x()}; }

/// A cell before its offset is known.
struct Face {
  double along_m = 0, distance_m = 0;
  WallEstimator::Cell cell;
};
using Faces = std::vector<Face>;  ///< of one sector

/// The cells of a column: one for each wall that stands apart from the others.
void addFaces(const SurfaceColumn& column, const WallSurfaceOptions& options, const Face& blank,
              const Eigen::Vector2d& direction, Faces& faces) {
  for (std::size_t begin = 0; begin < column.bins.size();) {
    std::size_t end = begin + 1;
    while (end < column.bins.size() && column.bins[end].height_cm - column.bins[end - 1].height_cm <= kApart_cm) ++end;
    const SurfaceBins bins(column.bins.begin() + static_cast<std::ptrdiff_t>(begin),
                           column.bins.begin() + static_cast<std::ptrdiff_t>(end));
    begin = end;
    if (totalCount(bins) < static_cast<std::uint32_t>(options.minPoints)) continue;
    Face face = blank;
    const SurfaceMiddle middle = middleOf(bins, column.pings);
    face.distance_m = middle.value_m;
    face.cell.sigma_m = middle.sigma_m;
    face.cell.count = totalCount(bins);
    face.cell.p_map.head<2>() += middle.value_m * direction;
    faces.push_back(face);
  }
}

/// Sets each cell's offset from the least squares line of distance over the place along the wall.
void setOffsets(Faces& faces, double reach_m) {
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) {
    return std::tie(a.along_m, a.cell.p_map.z(), a.distance_m) < std::tie(b.along_m, b.cell.p_map.z(), b.distance_m);
  });
  std::size_t first = 0;
  for (Face& here : faces) {
    while (faces[first].along_m < here.along_m - reach_m) ++first;
    double n = 0, s = 0, d = 0, ss = 0, sd = 0;
    for (std::size_t i = first; i < faces.size() && faces[i].along_m <= here.along_m + reach_m; ++i) {
      const double along_m = faces[i].along_m - here.along_m, distance_m = faces[i].distance_m - here.distance_m;
      if (std::abs(distance_m) > kSamePlane_m) continue;
      n += 1;
      s += along_m;
      d += distance_m;
      ss += along_m * along_m;
      sd += along_m * distance_m;
    }
    const double determinant = n * ss - s * s;
    // The line's value here; without extent along the wall it is the mean.
    here.cell.offset_m = determinant > 1e-9 ? -(d * ss - s * sd) / determinant : -d / n;
  }
}

}  // namespace

WallEstimator::WallEstimator(const WallSurfaceOptions& options) : options_(options), known_(kPlace_m) { clear(); }
WallEstimator::~WallEstimator() = default;
WallEstimator::WallEstimator(WallEstimator&&) noexcept = default;
WallEstimator& WallEstimator::operator=(WallEstimator&&) noexcept = default;

void WallEstimator::clear() {
  tiles_ = std::make_unique<SurfaceTiles>(static_cast<std::size_t>(std::max(1, options_.maxTilesInMemory)));
  known_ = SparseGrid<Known>(kPlace_m);
  epoch_ = 0;
}

bool WallEstimator::knows(const Eigen::Vector2d& place_m) const {
  SparseGrid<Known>::Hint hint;
  const Known* known = known_.find(known_.index(place_m.x()), known_.index(place_m.y()), hint);
  return known && known->sector >= 0;
}

void WallEstimator::learn(const Eigen::Vector2d& place_m, const Eigen::Vector2d& outward, double distance_m) {
  const double azimuth_rad = std::atan2(outward.y(), outward.x());
  const auto nearest = static_cast<std::int32_t>(std::lround(azimuth_rad / (2 * M_PI) * kSectors));
  const std::int32_t sector = (nearest + kSectors) % kSectors, ix = known_.index(place_m.x()),
                     iy = known_.index(place_m.y());
  for (int dx = -1; dx <= 1; ++dx)
    for (int dy = -1; dy <= 1; ++dy) {
      const Eigen::Vector2d middle = kPlace_m * Eigen::Vector2d(ix + dx + 0.5, iy + dy + 0.5);
      const double gap_m = outward.dot(middle) - distance_m;
      if (std::abs(gap_m) > kPlace_m * std::sqrt(0.5) + options_.reach_m) continue;
      Known& known = known_.at(ix + dx, iy + dy);
      if (known.sector >= 0) continue;
      known = {sector, directionOf(sector).dot(middle - gap_m * outward), ++epoch_};
    }
}

void WallEstimator::enter(const MapPoint& point, int sign, std::uint64_t epoch) {
  const bool isLine = point.layer == Layer::LineHorizontal || point.layer == Layer::LineVertical;
  if ((isLine && !point.isWall) || !point.p_map.allFinite() || !std::isfinite(point.sigma_m)) return;
  const Eigen::Vector2d place_m = point.p_map.head<2>();
  SparseGrid<Known>::Hint hint;
  const Known* known = known_.find(known_.index(place_m.x()), known_.index(place_m.y()), hint);
  if (!known || known->sector < 0 || known->epoch > epoch) return;
  const Eigen::Vector2d direction = directionOf(known->sector);
  const double distance_m = direction.dot(place_m);
  if (std::abs(distance_m - known->distance_m) > options_.reach_m) return;
  const double row = std::floor(point.p_map.z() / options_.cell_m) + kRows / 2.0;
  if (row < 0 || row >= kRows) return;
  const std::int32_t plane = 2 * known->sector + (point.layer == Layer::Lidar ? 0 : 1);
  SurfaceColumn& column =
      tiles_->at(static_cast<std::int32_t>(std::floor(alongOf(direction).dot(place_m) / options_.cell_m)),
                 plane * kRows + static_cast<std::int32_t>(row));
  enterValue(column, distance_m, std::max(static_cast<double>(point.sigma_m), options_.sigmaFloor_m), point.time, sign);
}

void WallEstimator::forEachCell(const std::function<void(const Cell&)>& visit) const {
  std::map<std::int32_t, Faces> sectors;
  tiles_->forEach([&](std::int32_t firstColumn, std::int32_t firstRow, const SurfaceTiles::Tile& tile) {
    const std::int32_t plane = firstRow / kRows;
    const Eigen::Vector2d direction = directionOf(plane / 2);
    Faces& faces = sectors[plane / 2];
    for (std::size_t i = 0; i < tile.size(); ++i) {
      if (tile[i].bins.empty()) continue;
      const auto column = firstColumn + static_cast<std::int32_t>(i % SurfaceTiles::kSide);
      const auto row = firstRow + static_cast<std::int32_t>(i / SurfaceTiles::kSide) - plane * kRows - kRows / 2;
      Face blank;
      blank.along_m = (column + 0.5) * options_.cell_m;
      blank.cell.outward_map = direction;
      blank.cell.bySonar = plane % 2 != 0;
      blank.cell.p_map.head<2>() = blank.along_m * alongOf(direction);
      blank.cell.p_map.z() = (row + 0.5) * options_.cell_m;
      addFaces(tile[i], options_, blank, direction, faces);
    }
  });
  for (auto& [sector, faces] : sectors) {
    setOffsets(faces, options_.planeReach_m);
    for (const Face& face : faces) visit(face.cell);
  }
}

}  // namespace s2s::map
