#include "s2s/odometry/plane_map.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "voxel_key.h"

namespace s2s::odometry {

namespace {

/// Thickness to be expected of a plane, and how many points' worth that knowledge is.
constexpr double kPriorThickness_m = 0.02;
constexpr double kPriorPoints = 6.0;
/// In-plane extents smaller than this share of the voxel's edge do not define a plane (a single scan line).
constexpr double kLeastExtent = 0.08;
/// A plane's thickness may be at most this share of its smaller extent.
constexpr double kMostAspect = 0.35;
/// A fit is renewed when the number of points has grown by this factor.
constexpr double kRefitGrowth = 1.3;

}  // namespace

PlaneMap::PlaneMap(const PlaneMapOptions& options) : options_(options), levels_(std::max(options.levels, 1)) {
  double size_m = options.voxel_m * static_cast<double>(1 << (levels_.size() - 1));
  for (auto& level : levels_) {
    level.size_m = size_m;
    size_m /= 2;
  }
  clear();
}

void PlaneMap::clear() {
  for (auto& level : levels_) {
    level.voxels.clear();
    level.slots.assign(1024, 0);
  }
}

std::size_t PlaneMap::size() const {
  std::size_t sum = 0;
  for (const auto& level : levels_) sum += level.voxels.size();
  return sum;
}

std::size_t PlaneMap::slotOf(const Level& level, std::uint64_t key) {
  const std::size_t mask = level.slots.size() - 1;
  std::size_t slot = voxelHash(key) & mask;
  while (level.slots[slot] != 0 && level.voxels[level.slots[slot] - 1].key != key) slot = (slot + 1) & mask;
  return slot;
}

void PlaneMap::grow(Level& level) {
  std::size_t count = 1024;
  while (count < 3 * level.voxels.size()) count *= 2;
  level.slots.assign(count, 0);
  for (std::size_t i = 0; i < level.voxels.size(); ++i)
    level.slots[slotOf(level, level.voxels[i].key)] = static_cast<std::uint32_t>(i + 1);
}

PlaneMap::Voxel& PlaneMap::findOrAdd(Level& level, std::uint64_t key) {
  std::size_t slot = slotOf(level, key);
  if (level.slots[slot] == 0) {
    if (level.slots.size() < 2 * (level.voxels.size() + 1)) {
      grow(level);
      slot = slotOf(level, key);
    }
    level.voxels.emplace_back();
    level.voxels.back().key = key;
    level.slots[slot] = static_cast<std::uint32_t>(level.voxels.size());
  }
  return level.voxels[level.slots[slot] - 1];
}

void PlaneMap::insert(const std::vector<Eigen::Vector3d>& points) {
  for (auto& level : levels_) {
    touched_.clear();
    const double perMetre = 1.0 / level.size_m;
    for (const auto& point : points) {
      const std::uint64_t key = voxelKey(point * perMetre);
      Voxel& voxel = findOrAdd(level, key);
      if (voxel.count >= options_.maxPoints) continue;
      const Eigen::Vector3f p = (point - voxelCentre(key) * level.size_m).cast<float>();
      ++voxel.count;
      const Eigen::Vector3f before = p - voxel.mean;
      voxel.mean += before / static_cast<float>(voxel.count);
      const Eigen::Vector3f after = p - voxel.mean;
      auto& s = voxel.scatter;
      s[0] += before.x() * after.x();
      s[1] += before.x() * after.y();
      s[2] += before.x() * after.z();
      s[3] += before.y() * after.y();
      s[4] += before.y() * after.z();
      s[5] += before.z() * after.z();
      const bool isDue = voxel.count >= options_.minPoints &&
                         (voxel.count >= kRefitGrowth * voxel.fitCount || voxel.count == options_.maxPoints);
      if (isDue) {
        voxel.fitCount = voxel.count;
        touched_.push_back(static_cast<std::uint32_t>(&voxel - level.voxels.data()));
      }
    }
    for (const auto index : touched_) fit(level.voxels[index], level.size_m);
  }
}

void PlaneMap::fit(Voxel& voxel, double size_m) const {
  const auto& s = voxel.scatter;
  Eigen::Matrix3d covariance;
  covariance << s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5];
  covariance /= voxel.count - 1.0;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  // The plane itself takes three of the points' degrees of freedom, which matters while they are few.
  const double thickness2 =
      std::max(solver.eigenvalues()[0] * (voxel.count - 1.0) / std::max(1.0, voxel.count - 3.0), 1e-6);
  const double extent2 = solver.eigenvalues()[1];
  const double leastExtent_m = kLeastExtent * size_m;
  voxel.isPlane = thickness2 <= options_.maxThickness_m * options_.maxThickness_m &&
                  extent2 >= leastExtent_m * leastExtent_m && thickness2 <= kMostAspect * kMostAspect * extent2;
  voxel.normal = solver.eigenvectors().col(0).cast<float>();
  // Few points may lie on a plane by chance, which would make it seem better known than it can be.
  const double free = std::max(0.0, voxel.count - 3.0);
  const double believed2 =
      (free * thickness2 + kPriorPoints * kPriorThickness_m * kPriorThickness_m) / (free + kPriorPoints);
  voxel.offsetVariance = static_cast<float>(believed2 / voxel.count);
  voxel.tiltVariance = static_cast<float>(believed2 / (voxel.count * extent2));
}

bool PlaneMap::match(const Eigen::Vector3d& point, PlaneMatch& out) const {
  for (const auto& level : levels_) {
    const std::uint64_t key = voxelKey(point * (1.0 / level.size_m));
    const std::uint32_t place = level.slots[slotOf(level, key)];
    if (place == 0) return false;  // nothing here, so nothing at the finer levels
    const Voxel& voxel = level.voxels[place - 1];
    if (!voxel.isPlane) continue;
    out.normal = voxel.normal.cast<double>();
    const Eigen::Vector3d fromMean = point - voxelCentre(key) * level.size_m - voxel.mean.cast<double>();
    out.distance_m = out.normal.dot(fromMean);
    const double along2 = fromMean.squaredNorm() - out.distance_m * out.distance_m;
    out.variance_m2 = voxel.offsetVariance + voxel.tiltVariance * along2;
    out.tiltVariance_rad2 = voxel.tiltVariance * (1.0 + options_.shapeShare * voxel.count);
    return true;
  }
  return false;
}

void PlaneMap::forgetBeyond(const Eigen::Vector3d& centre, double radius_m) {
  for (auto& level : levels_) {
    const auto isFar = [&](const Voxel& voxel) {
      return (voxelCentre(voxel.key) * level.size_m - centre).squaredNorm() > radius_m * radius_m;
    };
    const auto end = std::remove_if(level.voxels.begin(), level.voxels.end(), isFar);
    if (end == level.voxels.end()) continue;
    level.voxels.erase(end, level.voxels.end());
    grow(level);
  }
}

}  // namespace s2s::odometry
