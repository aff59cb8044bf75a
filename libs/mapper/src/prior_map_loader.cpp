#include "s2s/mapper/prior_map_loader.h"

#include <cmath>
#include <filesystem>

#include "s2s/core/error.h"
#include "s2s/products/ply_reader.h"
#include "s2s/products/trajectory_files.h"

namespace s2s::mapper {

namespace {

/// Index of the keyframe of a point's time; the file's doubles resolve a quarter of a microsecond.
std::optional<std::size_t> keyframeAt(const core::Trajectory& keyframes, core::TimeNs time) {
  constexpr core::TimeNs kTolerance = 1000;
  const auto& poses = keyframes.poses();
  const auto found = std::lower_bound(poses.begin(), poses.end(), time - kTolerance,
                                      [](const core::TimedPose& pose, core::TimeNs t) { return pose.time < t; });
  if (found == poses.end() || found->time > time + kTolerance) return std::nullopt;
  return static_cast<std::size_t>(found - poses.begin());
}

}  // namespace

std::unique_ptr<graph::PriorMap> loadPriorMap(const std::string& folder, const graph::GraphSlamOptions& options) {
  const auto file = [&folder](const char* name) { return (std::filesystem::path(folder) / name).string(); };
  const core::Trajectory keyframes = products::readTum(file("keyframes.tum"));
  std::vector<graph::PriorKeyframe> prior;
  for (const auto& pose : keyframes.poses()) prior.push_back({pose.T, {}});
  const auto thin = [&](graph::Cloud& cloud) {
    cloud = graph::voxelDownsampleTo(cloud, options.cloudVoxel_m, static_cast<std::size_t>(options.cloudPoints));
  };
  std::optional<std::size_t> current;  // the file has the points of one keyframe after the other
  products::forEachPlyPoint(file("lidar.ply"), [&](const products::PlyPoint& point) {
    const auto keyframe = keyframeAt(keyframes, std::llround(point.time_s * 1e9));
    if (!keyframe) return;
    if (current && *current != *keyframe) thin(prior[*current].cloud_vehicle);
    current = keyframe;
    auto& to = prior[*keyframe];
    to.cloud_vehicle.push_back((to.T_prior_vehicle.inverse() * point.p).cast<float>());
  });
  if (!current)
    throw core::InputError("no point of the old map belongs to a keyframe", file("lidar.ply"),
                           "give the output folder of a run of seabed-sky-map as it was written");
  thin(prior[*current].cloud_vehicle);
  return std::make_unique<graph::PriorMap>(std::move(prior), options.places, options.registration,
                                           options.loops.submap_m);
}

}  // namespace s2s::mapper
