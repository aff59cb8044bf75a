#include "s2s/eval/object_presence.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "s2s/eval/statistics.h"

namespace s2s::eval {

namespace {

/// One sample of an object's surface for each square of this side.
constexpr double kCoverSpacing_m = 0.05;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// The mesh without the vertices that no triangle uses, so that its extent is that of its triangles.
products::PlyMesh compacted(const products::PlyMesh& mesh) {
  products::PlyMesh result;
  for (const auto& triangle : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(result.vertices.size());
    for (const std::uint32_t vertex : triangle) result.vertices.push_back(mesh.vertices[vertex]);
    result.triangles.push_back({first, first + 1, first + 2});
  }
  result.object = mesh.object;
  return result;
}

}  // namespace

ObjectFinder::ObjectFinder(const TruthFolder& truth, double reach_m) : reach_m_(reach_m) {
  products::PlyMesh bare = truth.partOfKind("seabed");
  if (!bare.triangles.empty()) seabed_ = std::make_unique<MeshQuery>(std::move(bare));
  for (const auto& [number, object] : truth.objects) {
    if (object.kind != "object") continue;
    products::PlyMesh surface = compacted(truth.partOfObject(number));
    if (surface.triangles.empty()) continue;
    Candidate candidate;
    candidate.found.name = object.name;
    candidate.found.trueHeight_m = kNaN;  // stays so if no corner has seabed below; fmax passes over what is no number
    candidate.low = candidate.high = surface.vertices.front();
    for (const auto& v : surface.vertices) {
      candidate.low = candidate.low.cwiseMin(v);
      candidate.high = candidate.high.cwiseMax(v);
      candidate.found.trueHeight_m = std::fmax(candidate.found.trueHeight_m, heightAboveSeabed(v));
    }
    candidate.low.array() -= reach_m;
    candidate.high.array() += reach_m;
    candidate.surface = std::make_unique<MeshQuery>(std::move(surface));
    candidates_.push_back(std::move(candidate));
  }
}

double ObjectFinder::heightAboveSeabed(const Eigen::Vector3d& p_world) const {
  if (!seabed_) return kNaN;
  const auto height_m = seabed_->topHeight_m(p_world.x(), p_world.y());
  return height_m ? p_world.z() - *height_m : kNaN;
}

void ObjectFinder::measureCover(const MeshQuery& world, const core::Trajectory& path_world,
                                SurfaceRecallOptions options) {
  options.spacing_m = kCoverSpacing_m;
  for (auto& candidate : candidates_)
    candidate.seen =
        std::make_unique<VisibleSurface>(world, candidate.surface->mesh(), path_world, options.sonar, options);
}

void ObjectFinder::add(map::Layer layer, const Eigen::Vector3d& p_world) {
  const auto index = static_cast<std::size_t>(layer);
  for (auto& candidate : candidates_) {
    if (layer != map::Layer::Lidar && margin_m_ > 0 && (p_world.array() > candidate.low.array() - margin_m_).all() &&
        (p_world.array() < candidate.high.array() + margin_m_).all())
      candidate.kept.push_back({layer, p_world});
    if ((p_world.array() < candidate.low.array()).any() || (p_world.array() > candidate.high.array()).any()) continue;
    const auto nearest = candidate.surface->nearest(p_world, reach_m_);
    if (!nearest) continue;
    ++candidate.found.near[index];
    if (candidate.seen && layer != map::Layer::Lidar) candidate.seen->add(p_world);
    if (seabed_ && seabed_->nearest(p_world, nearest->distance_m)) continue;
    ++candidate.found.own[index];
    const double height_m = heightAboveSeabed(p_world);
    if (std::isfinite(height_m)) candidate.heights_m.push_back(height_m);
  }
}

std::vector<ObjectPresence> ObjectFinder::presence() const {
  std::vector<ObjectPresence> result;
  for (const auto& candidate : candidates_) {
    ObjectPresence presence = candidate.found;
    std::vector<double> heights_m = candidate.heights_m;
    std::sort(heights_m.begin(), heights_m.end());
    presence.mappedHeight_m = percentile(heights_m, 0.95);
    if (candidate.seen) {
      const SurfaceRecall recall = candidate.seen->recall();
      presence.seenArea_m2 = recall.area_m2;
      presence.covered = recall.within10cm;
    }
    result.push_back(std::move(presence));
  }
  return result;
}

}  // namespace s2s::eval
