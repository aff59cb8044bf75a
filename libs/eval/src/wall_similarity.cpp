#include "s2s/eval/wall_similarity.h"

#include <algorithm>
#include <cmath>
#include <nanoflann.hpp>
#include <string>

#include "s2s/core/error.h"
#include "s2s/eval/distribution.h"
#include "s2s/eval/statistics.h"

namespace s2s::eval {

namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr std::size_t kMinPoints = 20;

/// T_wall_map for a line through `middle` with direction angle `yaw_rad`.
core::Isometry wallFrame(const Eigen::Vector2d& middle, double yaw_rad, double waterHeight_m) {
  return core::isometryFromXyzYpr(middle.x(), middle.y(), waterHeight_m, yaw_rad, 0, 0).inverse();
}

/// The points of a cloud on the segment, in the wall's frame.
Points select(const Points& cloud_map, const core::Isometry& T_wall_map, const WallOptions& options, double length_m,
              double minHeight_m) {
  Points selected;
  for (const auto& p_map : cloud_map) {
    if (p_map.z() < minHeight_m) continue;
    const Eigen::Vector3d p = T_wall_map * p_map;
    if (std::abs(p.x()) <= 0.5 * length_m && std::abs(p.y()) <= options.halfWidth_m) selected.push_back(p);
  }
  return selected;
}

/// Removes the share of points with the lowest and with the highest y.
Points trim(Points points, double share) {
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.y() < b.y(); });
  const auto cut = static_cast<std::ptrdiff_t>(std::floor(share * static_cast<double>(points.size())));
  return {points.begin() + cut, points.end() - cut};
}

void requireEnough(const Points& points, const char* what) {
  if (points.size() >= kMinPoints) return;
  throw core::InputError("only " + std::to_string(points.size()) + " " + what + " points lie on the wall, " +
                             std::to_string(kMinPoints) + " are needed",
                         "", "check the ends of the wall and the half width, which are in metres in the map frame");
}

Points selectAndTrim(const Points& cloud_map, const core::Isometry& T_wall_map, const WallOptions& options,
                     double length_m, double minHeight_m, const char* what) {
  Points points = trim(select(cloud_map, T_wall_map, options, length_m, minHeight_m), options.trimShare);
  requireEnough(points, what);
  return points;
}

double medianMagnitude(const std::vector<double>& values) {
  std::vector<double> magnitudes;
  magnitudes.reserve(values.size());
  for (const double v : values) magnitudes.push_back(std::abs(v));
  const auto middle = magnitudes.begin() + static_cast<std::ptrdiff_t>(magnitudes.size() / 2);
  std::nth_element(magnitudes.begin(), middle, magnitudes.end());
  return *middle;
}

/// One step of iteratively reweighted least squares for the line y = offset + slope x with Huber's loss. The loss is
/// convex, so the line it ends at does not depend on where it began; trimming by y would stop at any small slope.
/// Returns how far the line moved at most over the length of the wall.
double improveLine(const Points& points, double length_m, double& offset_m, double& slope) {
  std::vector<double> residuals;
  residuals.reserve(points.size());
  for (const auto& p : points) residuals.push_back(p.y() - offset_m - slope * p.x());
  const double limit = 1.345 * 1.4826 * medianMagnitude(residuals);  // Huber's constant times the robust deviation
  double w = 0, wx = 0, wy = 0, wxx = 0, wxy = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double r = std::abs(residuals[i]), weight = r <= limit ? 1 : limit / r;
    const double x = points[i].x(), y = points[i].y();
    w += weight;
    wx += weight * x;
    wy += weight * y;
    wxx += weight * x * x;
    wxy += weight * x * y;
  }
  const double determinant = w * wxx - wx * wx;
  if (determinant <= 0) return 0;  // all at one place along the wall: no slope to be had
  const double newSlope = (w * wxy - wx * wy) / determinant, newOffset_m = (wy - newSlope * wx) / w;
  const double moved_m = std::abs(newOffset_m - offset_m) + 0.5 * length_m * std::abs(newSlope - slope);
  slope = newSlope;
  offset_m = newOffset_m;
  return moved_m;
}

/// Turns and shifts the wall's line onto the LiDAR points; the middle moves only across the wall.
void refine(const Points& lidar_map, const WallOptions& options, Eigen::Vector2d& middle, double& yaw_rad,
            double length_m) {
  constexpr int kRounds = 10, kSteps = 30;
  constexpr double kStands_m = 1e-5;  // far below what any sensor resolves
  // a round selects the points anew about the better line
  for (int round = 0; round < kRounds; ++round) {
    const core::Isometry T_wall_map = wallFrame(middle, yaw_rad, options.waterHeight_m);
    const Points points = select(lidar_map, T_wall_map, options, length_m, options.waterHeight_m);
    requireEnough(points, "LiDAR");
    double offset_m = 0, slope = 0;
    for (int step = 0; step < kSteps; ++step)
      if (improveLine(points, length_m, offset_m, slope) < kStands_m) break;
    middle += offset_m * Eigen::Vector2d(-std::sin(yaw_rad), std::cos(yaw_rad));
    yaw_rad += std::atan(slope);
    if (std::abs(offset_m) + 0.5 * length_m * std::abs(slope) < kStands_m) return;
  }
}

std::vector<double> yOf(const Points& points) {
  std::vector<double> y;
  y.reserve(points.size());
  for (const auto& p : points) y.push_back(p.y());
  return y;
}

WallCloud describe(const Points& points, const std::vector<double>& y_m) {
  WallCloud cloud;
  const std::vector<double> y = yOf(points);
  const Summary summary = summarise(y);
  cloud.points = points.size();
  cloud.width_m = summary.max - summary.min;
  cloud.meanY_m = summary.mean;
  cloud.stdY_m = summary.std;
  // A cloud without any spread would have a kernel without width; a micrometre is far below any sensor's noise.
  cloud.bandwidth_m = std::max(scottBandwidth(y), 1e-6);
  cloud.density = gaussianKde(y, cloud.bandwidth_m, y_m);
  return cloud;
}

/// Access for nanoflann: the horizontal coordinates of points.
struct HorizontalPoints {
  const Points& points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t dim) const { return points[i][static_cast<Eigen::Index>(dim)]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};
using HorizontalTree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, HorizontalPoints>,
                                                           HorizontalPoints, 2, std::size_t>;

double meanCosineSimilarity(const Points& lidar, const Points& sonar, bool in3d) {
  const HorizontalPoints access{lidar};
  const HorizontalTree tree(2, access);
  double sum = 0;
  std::size_t count = 0;
  for (const auto& p : sonar) {
    std::size_t index = 0;
    double squaredDistance = 0;
    const Eigen::Vector2d query = p.head<2>();
    tree.knnSearch(query.data(), 1, &index, &squaredDistance);
    Eigen::Vector3d a = p, b = lidar[index];
    if (!in3d) a.z() = b.z() = 0;
    const double norms = a.norm() * b.norm();
    if (norms <= 0) continue;  // the direction of the origin itself is not defined
    sum += a.dot(b) / norms;
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

std::vector<double> jointBins(const Points& lidar, const Points& sonar, int bins) {
  // Both are sorted by y after trimming.
  const double low = std::min(lidar.front().y(), sonar.front().y());
  const double high = std::max(lidar.back().y(), sonar.back().y());
  return binCentres(low, high, bins);
}

}  // namespace

WallReport compareWall(const Points& lidar_map, const Points& sonar_map, const WallOptions& options) {
  WallReport report;
  const Eigen::Vector2d along = options.to_m - options.from_m;
  report.length_m = along.norm();
  if (report.length_m < 1e-3 || options.halfWidth_m <= 0)
    throw core::InputError("the wall has no length or no width", "",
                           "give two different ends and a half width above 0");
  const Eigen::Vector2d givenMiddle = 0.5 * (options.from_m + options.to_m);
  const double givenYaw_rad = std::atan2(along.y(), along.x());
  Eigen::Vector2d middle = givenMiddle;
  double yaw_rad = givenYaw_rad;
  if (options.refine) refine(lidar_map, options, middle, yaw_rad, report.length_m);
  report.turn_rad = yaw_rad - givenYaw_rad;
  report.shift_m = (middle - givenMiddle).dot(Eigen::Vector2d(-along.y(), along.x())) / report.length_m;
  report.T_wall_map = wallFrame(middle, yaw_rad, options.waterHeight_m);

  const Points lidar =
      selectAndTrim(lidar_map, report.T_wall_map, options, report.length_m, options.waterHeight_m, "LiDAR");
  const Points sonar =
      selectAndTrim(sonar_map, report.T_wall_map, options, report.length_m, options.sonarMinHeight_m, "sonar");
  report.y_m = jointBins(lidar, sonar, options.bins);
  report.lidar = describe(lidar, report.y_m);
  report.sonar = describe(sonar, report.y_m);
  report.widthDifference_m = report.sonar.width_m - report.lidar.width_m;
  report.offset_m = report.sonar.meanY_m - report.lidar.meanY_m;
  report.cosineSimilarity = meanCosineSimilarity(lidar, sonar, options.cosineIn3d);
  report.hellinger = hellingerDistance(report.lidar.density, report.sonar.density);
  return report;
}

}  // namespace s2s::eval
