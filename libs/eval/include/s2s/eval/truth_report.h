#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "s2s/eval/layer_distance.h"
#include "s2s/eval/object_presence.h"
#include "s2s/eval/seabed_error.h"
#include "s2s/eval/surface_recall.h"
#include "s2s/eval/trajectory_error.h"

namespace s2s::eval {

struct TruthOptions {
  std::vector<double> rpeDistances_m = {1, 10};
  std::vector<double> segmentLengths_m = {10, 50, 100};
  TrajectoryAlignment mapAlignment = TrajectoryAlignment::Poses;
  std::size_t maxPointsPerLayer = 1'000'000;  ///< larger layers are sampled
  double objectReach_m = 0.1;
  std::string objectPictures;  ///< folder for a picture of each object that was seen; empty: none
  SeabedErrorOptions seabed;
  SurfaceRecallOptions recall;
};

struct RelativeErrorOver {
  double delta = 0;
  std::string unit;  ///< "frames" or "m"
  RelativeError error;
};

/// One trajectory against the truth.
struct TrajectoryReport {
  std::string name;  ///< file name
  std::size_t poses = 0;
  std::size_t pairs = 0;        ///< poses that have a true pose at their time
  double path_m = 0;            ///< true path between the first and the last pair
  AbsoluteError absolute;       ///< aligned by positions, as evo does
  Summary rotationByPoses_rad;  ///< rotation error after an alignment by poses, see TrajectoryAlignment
  std::vector<RelativeErrorOver> relative;
  std::vector<SegmentError> segments;
};

/// All layers of one medium together: how true the map is, and how much of what could be seen it holds.
struct MediumScore {
  std::string name;  ///< "above_water" (LiDAR) or "under_water" (all sonar layers)
  double precision5cm = 0, precision10cm = 0, precision20cm = 0;  ///< shares of points near the true surface
  SurfaceRecall recall;
};

struct TruthReport {
  std::vector<TrajectoryReport> trajectories;  ///< trajectory.tum, then odometry.tum if there is one
  TrajectoryAlignment mapAlignment = TrajectoryAlignment::Poses;
  core::Isometry T_world_map = core::Isometry::Identity();
  std::map<map::Layer, LayerDistance> layers;
  /// Cells of `walls.ply` by what saw them: "walls_lidar", "walls_sonar".
  std::map<std::string, LayerDistance> walls;
  std::vector<MediumScore> media;  ///< of those that have layers
  std::optional<SeabedError> seabed;
  std::vector<ObjectPresence> objects;
  std::vector<std::string> notes;  ///< what could not be compared, and why
};

/// Compares a map with the truth of the simulation it was made from. Nothing but the trajectories is aligned.
/// @throws core::InputError if a folder or file cannot be used, or the trajectories have no time in common
TruthReport evaluateAgainstTruth(const std::string& mapFolder, const std::string& truthFolder,
                                 const TruthOptions& options);

/// Transform that takes the map onto the true world by the trajectories alone.
/// @throws core::InputError if they have no time in common
core::Isometry alignMapToTruth(const core::Trajectory& truth, const core::Trajectory& estimate,
                               TrajectoryAlignment alignment);

}  // namespace s2s::eval
