#include "s2s/eval/target_picker.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "s2s/core/error.h"
#include "s2s/core/option_table.h"
#include "s2s/eval/map_folder.h"
#include "s2s/eval/truth_folder.h"
#include "s2s/eval/truth_report.h"
#include "s2s/products/ply_reader.h"

namespace s2s::eval {

namespace {

using Points = std::vector<Eigen::Vector3d>;

Points within(const Points& points, const Eigen::Vector3d& centre, double radius_m) {
  Points near;
  for (const auto& p : points)
    if ((p - centre).norm() <= radius_m) near.push_back(p);
  return near;
}

Eigen::Vector3d meanOf(const Points& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

/// The returns of the densest group: mean shift from every return, the end with the most returns wins.
Points densestGroup(const Points& bright, double radius_m) {
  constexpr std::size_t kMaxStarts = 200;  // of thousands of returns on one board every n-th begins as well
  const std::size_t step = 1 + bright.size() / kMaxStarts;
  Points best;
  for (std::size_t start = 0; start < bright.size(); start += step) {
    Eigen::Vector3d centre = bright[start];
    Points group;
    for (int round = 0; round < 20; ++round) {
      group = within(bright, centre, radius_m);
      const Eigen::Vector3d mean = meanOf(group);
      const bool stands = (mean - centre).norm() < 1e-4;
      centre = mean;
      if (stands) break;
    }
    if (group.size() > best.size()) best = std::move(group);
  }
  return best;
}

/// Halfway between the extremes along each principal axis.
Eigen::Vector3d middleOf(const Points& points) {
  const Eigen::Vector3d mean = meanOf(points);
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const auto& p : points) scatter += (p - mean) * (p - mean).transpose();
  const Eigen::Matrix3d axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  Eigen::Vector3d low(kInf, kInf, kInf), high = -low;
  for (const auto& p : points) {
    const Eigen::Vector3d q = axes.transpose() * (p - mean);
    low = low.cwiseMin(q);
    high = high.cwiseMax(q);
  }
  Eigen::Vector3d middle = 0.5 * (low + high);
  middle[0] = 0;  // across the board the spread is noise, whose mean is better than its extremes
  return mean + axes * middle;
}

}  // namespace

TargetPicker::TargetPicker(std::vector<NamedPoint> expected, const TargetPickerOptions& options)
    : expected_(std::move(expected)), options_(options), bright_(expected_.size()) {}

void TargetPicker::add(const Eigen::Vector3d& p, double intensity) {
  if (!(intensity >= options_.minIntensity)) return;
  for (std::size_t i = 0; i < expected_.size(); ++i)
    if ((p - expected_[i].position).norm() <= options_.searchRadius_m) bright_[i].push_back(p);
}

std::vector<TargetPick> TargetPicker::picks() const {
  std::vector<TargetPick> result;
  for (std::size_t i = 0; i < expected_.size(); ++i) result.push_back(pick(expected_[i], bright_[i]));
  return result;
}

TargetPick TargetPicker::pick(const NamedPoint& expected, const Points& bright) const {
  TargetPick result;
  result.id = expected.id;
  result.position = expected.position;
  const Points group = densestGroup(bright, options_.targetRadius_m);
  result.points = group.size();
  if (group.size() < static_cast<std::size_t>(options_.minPoints)) return result;
  result.found = true;
  result.position = middleOf(group);
  double squares = 0;
  for (const auto& p : group) squares += (p - result.position).squaredNorm();
  result.spread_m = std::sqrt(squares / static_cast<double>(group.size()));
  return result;
}

std::vector<TargetPick> pickTargets(const std::string& mapFolder, const PickOptions& options) {
  const MapFolder map(mapFolder);
  std::vector<NamedPoint> expected = readNamedPoints(options.pointsFile);
  if (!options.truthFolder.empty()) {
    const core::Isometry T_map_world =
        alignMapToTruth(readTruthTrajectory(options.truthFolder), map.trajectory(), TrajectoryAlignment::Poses)
            .inverse();
    for (auto& point : expected) point.position = T_map_world * point.position;
  }
  const auto file = map.layerFile(map::Layer::Lidar);
  if (!file)
    throw core::InputError("the map has no layer lidar", mapFolder, "targets can only be picked in a LiDAR map");
  TargetPicker picker(std::move(expected), options.picker);
  products::forEachPlyPoint(
      *file, [&](const products::PlyPoint& point) { picker.add(point.p, static_cast<double>(point.intensity)); });
  return picker.picks();
}

std::string picksCsv(const std::vector<TargetPick>& picks) {
  std::string text = "id,x,y,z\n";
  for (const auto& pick : picks) {
    if (!pick.found) continue;
    text += pick.id;
    for (int axis = 0; axis < 3; ++axis) text += ',' + core::printDouble(pick.position[axis]);
    text += '\n';
  }
  return text;
}

}  // namespace s2s::eval
