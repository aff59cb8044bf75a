#include "s2s/eval/truth_report.h"

#include "s2s/core/error.h"
#include "s2s/core/time.h"
#include "s2s/eval/map_folder.h"
#include "s2s/eval/object_pictures.h"
#include "s2s/eval/truth_folder.h"
#include "s2s/products/ply_reader.h"

namespace s2s::eval {

namespace {

std::vector<PosePair> pairOrRefuse(const core::Trajectory& truth, const core::Trajectory& estimate) {
  std::vector<PosePair> pairs = pairByTime(truth, estimate);
  if (!pairs.empty()) return pairs;
  const auto span = [](const core::Trajectory& t) {
    return t.empty() ? std::string("no poses")
                     : core::formatUtc(t.front().time) + " to " + core::formatUtc(t.back().time);
  };
  throw core::InputError("the trajectories have no time in common: truth " + span(truth) + ", map " + span(estimate),
                         "", "compare a map with the truth of the survey it was made from");
}

double truePath_m(const std::vector<PosePair>& pairs) {
  double length_m = 0;
  for (std::size_t i = 1; i < pairs.size(); ++i)
    length_m += (pairs[i].T_ref_body.translation() - pairs[i - 1].T_ref_body.translation()).norm();
  return length_m;
}

TrajectoryReport reportTrajectory(const std::string& name, const core::Trajectory& truth,
                                  const core::Trajectory& estimate, const TruthOptions& options) {
  const std::vector<PosePair> pairs = pairOrRefuse(truth, estimate);
  TrajectoryReport report;
  report.name = name;
  report.poses = estimate.size();
  report.pairs = pairs.size();
  report.path_m = truePath_m(pairs);
  report.absolute = absoluteError(pairs, TrajectoryAlignment::Positions);
  report.rotationByPoses_rad = absoluteError(pairs, TrajectoryAlignment::Poses).rotation_rad;
  report.relative.push_back({1, "frames", relativeErrorOverFrames(pairs, 1)});
  for (const double distance_m : options.rpeDistances_m)
    report.relative.push_back({distance_m, "m", relativeErrorOverDistance(pairs, distance_m)});
  for (const double length_m : options.segmentLengths_m) report.segments.push_back(segmentError(pairs, length_m));
  return report;
}

/// The true path during the time of the map; a map of a part of the survey is not asked for the rest.
core::Trajectory truePathOf(const core::Trajectory& truth, const core::Trajectory& estimate) {
  std::vector<core::TimedPose> poses;
  for (const auto& pair : pairByTime(truth, estimate)) poses.push_back({pair.time, pair.T_ref_body});
  return core::Trajectory(std::move(poses));
}

/// How much of an object's surroundings its picture shows.
constexpr double kPictureMargin_m = 1.0;

/// Everything that each point of the map is shown to.
struct PointConsumers {
  ObjectFinder finder;
  VisibleSurface aboveWater, underWater;

  void add(map::Layer layer, const Eigen::Vector3d& p_world) {
    finder.add(layer, p_world);
    (layer == map::Layer::Lidar ? aboveWater : underWater).add(p_world);
  }
};

void measureLayer(const std::string& file, map::Layer layer, const MeshQuery& world, PointConsumers& consumers,
                  const TruthOptions& options, TruthReport& report) {
  PointSample sample(options.maxPointsPerLayer);
  std::uint64_t notFinite = 0;
  products::forEachPlyPoint(file, [&](const products::PlyPoint& point) {
    if (!point.p.allFinite()) {
      ++notFinite;
      return;
    }
    const Eigen::Vector3d p_world = report.T_world_map * point.p;
    sample.add(p_world);
    consumers.add(layer, p_world);
  });
  report.layers[layer] = measureLayer(world, sample.points(), sample.offered());
  if (notFinite > 0)
    report.notes.push_back(std::string("layer ") + map::layerName(layer) + ": " + std::to_string(notFinite) +
                           " points are not finite and were left out");
}

/// Precision of the LiDAR layer, or of all others in proportion to their points; nothing without any points.
std::optional<MediumScore> scoreMedium(const std::string& name, bool lidar, const TruthReport& report,
                                       const VisibleSurface& surface) {
  MediumScore score;
  double points = 0;
  for (const auto& [layer, distance] : report.layers) {
    if ((layer == map::Layer::Lidar) != lidar) continue;
    const auto n = static_cast<double>(distance.points);
    points += n;
    score.precision5cm += n * distance.within5cm;
    score.precision10cm += n * distance.within10cm;
    score.precision20cm += n * distance.within20cm;
  }
  if (points <= 0) return std::nullopt;
  for (double* precision : {&score.precision5cm, &score.precision10cm, &score.precision20cm}) *precision /= points;
  score.name = name;
  score.recall = surface.recall();
  return score;
}

/// The faces of walls, each cell by its middle.
void measureWalls(const std::string& file, const MeshQuery& world, TruthReport& report) {
  std::map<std::string, std::vector<Eigen::Vector3d>> faces;
  products::forEachPlyPoint(file, [&](const products::PlyPoint& point) {
    faces[point.source == 0 ? "walls_lidar" : "walls_sonar"].push_back(report.T_world_map * point.p);
  });
  for (const auto& [name, points] : faces) report.walls[name] = measureLayer(world, points, points.size());
}

void measureLayers(const MapFolder& map, const TruthFolder& truth, const core::Trajectory& path,
                   const TruthOptions& options, TruthReport& report) {
  const MeshQuery world(truth.world);
  PointConsumers consumers{ObjectFinder(truth, options.objectReach_m),
                           VisibleSurface(world, path, options.recall.lidar, options.recall),
                           VisibleSurface(world, path, options.recall.sonar, options.recall)};
  consumers.finder.measureCover(world, path, options.recall);
  if (!options.objectPictures.empty()) consumers.finder.keepPoints(kPictureMargin_m);
  for (const map::Layer layer : map::kLayers) {
    if (const auto file = map.layerFile(layer))
      measureLayer(*file, layer, world, consumers, options, report);
    else
      report.notes.push_back(std::string("layer ") + map::layerName(layer) + ": no such file in the map folder");
  }
  if (const auto file = map.wallFile()) measureWalls(*file, world, report);
  report.objects = consumers.finder.presence();
  if (!options.objectPictures.empty()) writeObjectPictures(consumers.finder, options.objectPictures);
  if (auto score = scoreMedium("above_water", true, report, consumers.aboveWater))
    report.media.push_back(std::move(*score));
  if (auto score = scoreMedium("under_water", false, report, consumers.underWater))
    report.media.push_back(std::move(*score));
}

void measureSeabed(const MapFolder& map, const TruthFolder& truth, const core::Trajectory& path,
                   const TruthOptions& options, TruthReport& report) {
  const auto grid = map.seabed();
  products::PlyMesh surface = truth.groundUnderWater();
  if (!grid)
    report.notes.emplace_back("seabed: no seabed.tif in the map folder");
  else if (surface.triangles.empty())
    report.notes.emplace_back("seabed: the true world has no object of kind 'seabed'");
  else
    report.seabed = compareSeabed(*grid, report.T_world_map, MeshQuery(std::move(surface)), path, options.seabed);
}

}  // namespace

core::Isometry alignMapToTruth(const core::Trajectory& truth, const core::Trajectory& estimate,
                               TrajectoryAlignment alignment) {
  return absoluteError(pairOrRefuse(truth, estimate), alignment).T_ref_est;
}

TruthReport evaluateAgainstTruth(const std::string& mapFolder, const std::string& truthFolder,
                                 const TruthOptions& options) {
  const MapFolder map(mapFolder);
  const TruthFolder truth = readTruthFolder(truthFolder);
  TruthReport report;
  const core::Trajectory trajectory = map.trajectory();
  report.trajectories.push_back(reportTrajectory("trajectory.tum", truth.trajectory, trajectory, options));
  if (const auto odometry = map.odometry())
    report.trajectories.push_back(reportTrajectory("odometry.tum", truth.trajectory, *odometry, options));
  else
    report.notes.emplace_back("odometry: no odometry.tum in the map folder");
  report.mapAlignment = options.mapAlignment;
  report.T_world_map = alignMapToTruth(truth.trajectory, trajectory, options.mapAlignment);

  const core::Trajectory path = truePathOf(truth.trajectory, trajectory);
  measureLayers(map, truth, path, options, report);
  measureSeabed(map, truth, path, options, report);
  return report;
}

}  // namespace s2s::eval
