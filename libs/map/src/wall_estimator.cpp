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
/// How far along a wall its profile is looked for that the sonar does not resolve, and cells or places that show it.
constexpr double kProfileReach_m = 2;
constexpr std::size_t kMinProfile = 4;

Eigen::Vector2d directionOf(std::int32_t sector) {
  const double azimuth_rad = 2 * M_PI * sector / kSectors;
  return {std::cos(azimuth_rad), std::sin(azimuth_rad)};
}

Eigen::Vector2d alongOf(const Eigen::Vector2d& direction) { return {-direction.y(), direction.x()}; }

/// A cell before its offset is known.
struct Face {
  double along_m = 0, distance_m = 0;
  double sigma_m = 0;  ///< by the cell's own points
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
    face.sigma_m = face.cell.sigma_m = middle.sigma_m;
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

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double variance(const std::vector<double>& values) {
  const double middle = mean(values);
  double sum = 0;
  for (const double value : values) sum += (value - middle) * (value - middle);
  return sum / static_cast<double>(values.size() - 1);
}

/// Variance of values about their line over a place; the direction of a sector is not quite that of its walls.
double varianceAboutLine(const std::vector<double>& places, const std::vector<double>& values) {
  const double place = mean(places), value = mean(values);
  double pp = 0, pv = 0, vv = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double p = places[i] - place, v = values[i] - value;
    pp += p * p;
    pv += p * v;
    vv += v * v;
  }
  return std::max(0.0, vv - (pp > 0 ? pv * pv / pp : 0)) / static_cast<double>(values.size() - 1);
}

/// What the sonar's cells around one do not show of the profile that the LiDAR's show above them.
///
/// The variance of their differences, of one place along the wall each, as far as the cells' own sigmas do not explain
/// it, and the square of their mean, since the sonar's line may go anywhere through a profile. The mean counts up to
/// the profile's own depth only: a wall may as well have a step at the water. Without enough pairs, that depth counts
/// alone.
double unresolvedVariance(const Faces& faces, std::size_t begin, std::size_t end, const Face& here) {
  std::vector<double> differences_m, claimed, profile_m, places_m;
  for (std::size_t i = begin; i < end;) {
    std::size_t next = i;
    std::vector<double> lidar_m;
    for (; next < end && faces[next].along_m == faces[i].along_m; ++next)
      if (!faces[next].cell.bySonar && std::abs(faces[next].distance_m - here.distance_m) <= kSamePlane_m)
        lidar_m.push_back(faces[next].distance_m);
    if (!lidar_m.empty()) {
      profile_m.push_back(mean(lidar_m));
      places_m.push_back(faces[i].along_m);
    }
    for (; i < next; ++i) {
      const Face& face = faces[i];
      if (lidar_m.empty() || !face.cell.bySonar || std::abs(face.distance_m - here.distance_m) > kSamePlane_m) continue;
      differences_m.push_back(face.distance_m - profile_m.back());
      claimed.push_back(face.sigma_m * face.sigma_m);
    }
  }
  const double depth2 = profile_m.size() >= kMinProfile ? varianceAboutLine(places_m, profile_m) : 0;
  if (differences_m.size() < kMinProfile) return depth2;
  const double middle_m = mean(differences_m);
  return std::max(0.0, variance(differences_m) - mean(claimed)) + std::min(middle_m * middle_m, depth2);
}

/// A sonar's ridge is straight over some degrees of bearing: where the wall has a profile it goes through the middle of
/// it, and all pings agree on that. So the cells' scatter does not tell, and the LiDAR's view of the wall has to.
void addUnresolvedProfile(Faces& faces) {
  std::size_t begin = 0, end = 0;
  for (Face& here : faces) {
    while (faces[begin].along_m < here.along_m - kProfileReach_m) ++begin;
    while (end < faces.size() && faces[end].along_m <= here.along_m + kProfileReach_m) ++end;
    if (here.cell.bySonar)
      here.cell.sigma_m = std::sqrt(here.sigma_m * here.sigma_m + unresolvedVariance(faces, begin, end, here));
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
    addUnresolvedProfile(faces);
    for (const Face& face : faces) visit(face.cell);
  }
}

}  // namespace s2s::map
