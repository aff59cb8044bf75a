#include "s2s/eval/wall_report.h"

#include "s2s/core/error.h"
#include "s2s/eval/map_folder.h"
#include "s2s/eval/truth_folder.h"
#include "s2s/eval/truth_report.h"
#include "s2s/products/ply_reader.h"

namespace s2s::eval {

namespace {

/// Reads those points of a layer that can be near the wall, a little more than `compareWall` will take.
void readNear(const MapFolder& map, map::Layer layer, const core::Isometry& T_frame_map, const WallOptions& wall,
              std::vector<Eigen::Vector3d>& points) {
  const auto file = map.layerFile(layer);
  if (!file)
    throw core::InputError(std::string("the map has no layer ") + map::layerName(layer), "",
                           "leave the layer out, or make the map with that sensor");
  // The line may be turned by the refinement, by at most about the half width at its ends.
  const Eigen::Vector2d middle = 0.5 * (wall.from_m + wall.to_m);
  const double reach_m = 0.5 * (wall.to_m - wall.from_m).norm() + 3 * wall.halfWidth_m;
  products::forEachPlyPoint(*file, [&](const products::PlyPoint& point) {
    const Eigen::Vector3d p = T_frame_map * point.p;
    if (p.allFinite() && (p.head<2>() - middle).norm() <= reach_m) points.push_back(p);
  });
}

double waterHeight(const MapFolder& map, const WallReportOptions& options) {
  if (options.waterHeight_m) return *options.waterHeight_m;
  if (const auto stated = map.waterHeight_m()) return *stated;
  throw core::InputError("the height of the water surface is not known: summary.json does not state water_height_m", "",
                         "state it with --water-height");
}

}  // namespace

WallReport evaluateWall(const std::string& mapFolder, const WallReportOptions& options) {
  const MapFolder map(mapFolder);
  WallOptions wall = options.wall;
  core::Isometry T_frame_map = core::Isometry::Identity();
  wall.waterHeight_m = waterHeight(map, options);
  if (!options.truthFolder.empty()) {
    T_frame_map =
        alignMapToTruth(readTruthTrajectory(options.truthFolder), map.trajectory(), TrajectoryAlignment::Poses);
    // Both frames have z up, so a height changes by the shift between them at the wall.
    const Eigen::Vector2d middle = 0.5 * (wall.from_m + wall.to_m);
    const Eigen::Vector3d p_map = T_frame_map.inverse() * Eigen::Vector3d(middle.x(), middle.y(), 0);
    wall.waterHeight_m = (T_frame_map * Eigen::Vector3d(p_map.x(), p_map.y(), wall.waterHeight_m)).z();
  }
  if (options.sonarMaxDepth_m) wall.sonarMinHeight_m = wall.waterHeight_m - *options.sonarMaxDepth_m;
  std::vector<Eigen::Vector3d> lidar, sonar;
  readNear(map, map::Layer::Lidar, T_frame_map, wall, lidar);
  for (const map::Layer layer : options.sonarLayers) readNear(map, layer, T_frame_map, wall, sonar);
  return compareWall(lidar, sonar, wall);
}

}  // namespace s2s::eval
