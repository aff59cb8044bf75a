#include "s2s/eval/surface_recall.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace s2s::eval {

namespace {

/// Places of the sensor, `step_m` apart along the path.
std::vector<Eigen::Vector3d> eyesAlong(const core::Trajectory& path, const Eigen::Vector3d& eye_vehicle_m,
                                       double step_m) {
  std::vector<Eigen::Vector3d> eyes;
  for (const auto& pose : path.poses()) {
    const Eigen::Vector3d eye = pose.T * eye_vehicle_m;
    if (eyes.empty() || (eye - eyes.back()).norm() >= step_m) eyes.push_back(eye);
  }
  return eyes;
}

bool visible(const MeshQuery& world, const std::vector<Eigen::Vector3d>& eyes, const Eigen::Vector3d& p,
             const VisibilityOptions& options) {
  for (const auto& eye : eyes) {
    const Eigen::Vector3d ray = p - eye;
    if (ray.squaredNorm() > options.range_m * options.range_m) continue;
    if (std::abs(std::atan2(ray.z(), ray.head<2>().norm())) > options.maxElevation_rad) continue;
    if (!world.blocked(eye, p)) return true;
  }
  return false;
}

/// Calls `visit` with random places on the triangles of a mesh, one for each `area_m2` on average. Triangles that lie
/// wholly outside the box are passed over.
template <class Visit>
void sampleSurface(const products::PlyMesh& mesh, const Eigen::AlignedBox3d& box, double area_m2, Visit&& visit) {
  std::mt19937_64 random(1);
  const auto uniform = [&] { return static_cast<double>(random() >> 11U) * 0x1.0p-53; };
  for (const auto& [ia, ib, ic] : mesh.triangles) {
    const Eigen::Vector3d &a = mesh.vertices[ia], &b = mesh.vertices[ib], &c = mesh.vertices[ic];
    Eigen::AlignedBox3d extent(a);
    extent.extend(b).extend(c);
    if (!box.intersects(extent)) continue;
    const double expected = 0.5 * (b - a).cross(c - a).norm() / area_m2;
    const auto count = static_cast<std::uint64_t>(std::floor(expected + uniform()));
    for (std::uint64_t i = 0; i < count; ++i) {
      // Uniform over the triangle by folding the unit square (Turk 1990).
      double u = uniform(), v = uniform();
      if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
      }
      const Eigen::Vector3d p = a + u * (b - a) + v * (c - a);
      if (box.contains(p)) visit(p);
    }
  }
}

}  // namespace

VisibleSurface::VisibleSurface(const MeshQuery& world, const core::Trajectory& path_world,
                               const VisibilityOptions& visibility, const SurfaceRecallOptions& options)
    : VisibleSurface(world, world.mesh(), path_world, visibility, options) {}

VisibleSurface::VisibleSurface(const MeshQuery& world, const products::PlyMesh& part,
                               const core::Trajectory& path_world, const VisibilityOptions& visibility,
                               const SurfaceRecallOptions& options)
    : spacing_m_(options.spacing_m) {
  const auto eyes = eyesAlong(path_world, visibility.eye_vehicle_m, options.pathStep_m);
  if (eyes.empty()) return;
  Eigen::AlignedBox3d box;
  for (const auto& eye : eyes) box.extend(eye);
  const Eigen::Vector3d range = Eigen::Vector3d::Constant(visibility.range_m);
  box = Eigen::AlignedBox3d(Eigen::Vector3d(box.min() - range), Eigen::Vector3d(box.max() + range));
  box.min().z() = std::max(box.min().z(), visibility.minHeight_m);
  box.max().z() = std::min(box.max().z(), visibility.maxHeight_m);
  sampleSurface(part, box, spacing_m_ * spacing_m_, [&](const Eigen::Vector3d& p) {
    if (!visible(world, eyes, p, visibility)) return;
    const Eigen::Vector3i cell = (p / kCell_m).array().floor().matrix().cast<int>();
    cells_[keyOf(cell)].push_back(static_cast<std::uint32_t>(samples_.size()));
    samples_.push_back({p});
  });
}

std::uint64_t VisibleSurface::keyOf(const Eigen::Vector3i& cell) {
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) key = key << 21U | (static_cast<std::uint32_t>(cell[axis]) & 0x1FFFFFU);
  return key;
}

void VisibleSurface::add(const Eigen::Vector3d& p_world) {
  // The cell whose corner is nearest, and its seven neighbours at that corner.
  const Eigen::Vector3i first =
      (p_world / kCell_m - Eigen::Vector3d::Constant(0.5)).array().floor().matrix().cast<int>();
  for (int n = 0; n < 8; ++n) {
    const auto found = cells_.find(keyOf(first + Eigen::Vector3i(n & 1, n >> 1 & 1, n >> 2 & 1)));
    if (found == cells_.end()) continue;
    for (const std::uint32_t i : found->second)
      samples_[i].squaredDistance_m2 =
          std::min(samples_[i].squaredDistance_m2, (samples_[i].p - p_world).squaredNorm());
  }
}

SurfaceRecall VisibleSurface::recall() const {
  SurfaceRecall recall;
  recall.samples = samples_.size();
  recall.area_m2 = static_cast<double>(samples_.size()) * spacing_m_ * spacing_m_;
  if (samples_.empty()) return recall;
  const auto share = [&](double limit_m) {
    const auto near = std::count_if(samples_.begin(), samples_.end(),
                                    [&](const Sample& s) { return s.squaredDistance_m2 <= limit_m * limit_m; });
    return static_cast<double>(near) / static_cast<double>(samples_.size());
  };
  recall.within5cm = share(0.05);
  recall.within10cm = share(0.10);
  recall.within20cm = share(kReach_m);
  return recall;
}

double fScore(double precision, double recall) {
  return precision + recall > 0 ? 2 * precision * recall / (precision + recall) : 0;
}

}  // namespace s2s::eval
