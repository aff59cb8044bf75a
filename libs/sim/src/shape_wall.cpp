#include <cmath>

#include "s2s/sim/random.h"
#include "s2s/sim/shapes.h"

namespace s2s::sim {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// Position and outward normal at a distance along a polyline.
struct LinePoint {
  Vector2d position, normal;
};

class Polyline {
 public:
  explicit Polyline(const std::vector<Vector2d>& points) : points_(points), lengths_{0} {
    for (std::size_t i = 1; i < points.size(); ++i)
      lengths_.push_back(lengths_.back() + (points[i] - points[i - 1]).norm());
  }
  double length() const { return lengths_.back(); }
  LinePoint at(double s) const {
    std::size_t i = 1;
    while (i + 1 < lengths_.size() && lengths_[i] < s) ++i;
    const Vector2d along = (points_[i] - points_[i - 1]).normalized();
    return {points_[i - 1] + (s - lengths_[i - 1]) * along, {-along.y(), along.x()}};
  }

 private:
  std::vector<Vector2d> points_;
  std::vector<double> lengths_;
};

/// How far the face stands out of the line (negative: behind it) at a place of a wall of stone blocks.
double stoneRelief_m(const WallOptions& o, std::uint64_t seed, double s, double z) {
  const double rowPosition = (z - o.bottom_m) / o.blockHeight_m;
  const double row = std::floor(rowPosition);
  const double shift = 0.5 * (static_cast<std::int64_t>(row) % 2);  // running bond
  const double columnPosition = s / o.blockLength_m + shift;
  const double column = std::floor(columnPosition);
  const double toJoint_m =
      std::min({(columnPosition - column) * o.blockLength_m, (column + 1 - columnPosition) * o.blockLength_m,
                (rowPosition - row) * o.blockHeight_m, (row + 1 - rowPosition) * o.blockHeight_m});
  constexpr double kJointHalfWidth_m = 0.04;
  const double joint = toJoint_m < kJointHalfWidth_m ? -o.jointDepth_m : 0;
  const double block = hashUniform(seed, static_cast<std::int64_t>(column), static_cast<std::int64_t>(row)) - 0.5;
  return joint + std::sqrt(12.0) * o.roughness_m * block +
         0.3 * o.roughness_m * fractalNoise(seed + 7, s / 0.4, z / 0.4, 2);
}

/// The Z-profile of steel sheet piles: out, slope, in, slope.
double sheetPileRelief_m(const WallOptions& o, double s) {
  const double u = s / o.pileLength_m - std::floor(s / o.pileLength_m);
  if (u < 0.3) return 0;
  if (u < 0.5) return -o.pileDepth_m * (u - 0.3) / 0.2;
  if (u < 0.8) return -o.pileDepth_m;
  return -o.pileDepth_m * (1 - u) / 0.2;
}

std::vector<double> samplesAlong(const WallOptions& o, double length) {
  std::vector<double> samples;
  if (o.style == WallStyle::SheetPile) {
    for (int wave = 0; wave * o.pileLength_m < length; ++wave)
      for (const double u : {0.0, 0.3, 0.5, 0.8}) {
        const double place = (wave + u) * o.pileLength_m;
        if (place < length) samples.push_back(place);
      }
    samples.push_back(length);
    return samples;
  }
  const double step = o.style == WallStyle::Stone ? o.resolution_m : 2.0;
  const auto n = std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(length / step)));
  for (std::size_t i = 0; i <= n; ++i) samples.push_back(length * static_cast<double>(i) / static_cast<double>(n));
  return samples;
}

}  // namespace

TriangleMesh makeWall(const std::vector<Vector2d>& line, const WallOptions& o, std::uint64_t seed) {
  const Polyline polyline(line);
  const std::vector<double> along = samplesAlong(o, polyline.length());
  const double zStep = o.style == WallStyle::Stone ? o.resolution_m : 1.0;
  const auto rows = static_cast<std::size_t>(std::ceil((o.top_m - o.bottom_m) / zStep)) + 1;
  TriangleMesh mesh;
  for (std::size_t r = 0; r < rows; ++r)
    for (const double s : along) {
      const double z = o.bottom_m + (o.top_m - o.bottom_m) * static_cast<double>(r) / static_cast<double>(rows - 1);
      double relief = 0;
      if (o.style == WallStyle::Stone) relief = stoneRelief_m(o, seed, s, z);
      if (o.style == WallStyle::SheetPile) relief = sheetPileRelief_m(o, s);
      const LinePoint p = polyline.at(s);
      const Vector2d xy = p.position + relief * p.normal;
      mesh.addVertex({xy.x(), xy.y(), z});
    }
  mesh.addGrid(0, rows, along.size());
  return mesh;
}

}  // namespace s2s::sim
