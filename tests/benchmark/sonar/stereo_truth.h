#pragma once

#include <string>
#include <vector>

#include "s2s/core/trajectory.h"
#include "s2s/eval/mesh_query.h"
#include "s2s/obs/CObservationImagingSonar.h"
#include "s2s/sonar/options_table.h"

namespace s2s::bench {

/// What a simulated survey truly was: trajectory, mountings and world.
class SurveyTruth {
 public:
  /// @param folder the simulator's output folder
  explicit SurveyTruth(const std::string& folder);

  /// T_world_sensor at a time; nothing outside the trajectory.
  std::optional<core::Isometry> T_world_sensor(const std::string& label, core::TimeNs time) const;
  /// Distance to the world's surface, at most `limit_m`.
  double distance_m(const Eigen::Vector3d& p_world, double limit_m) const;
  /// Height of the topmost surface at the point's place.
  double topHeight_m(const Eigen::Vector3d& p_world) const;
  /// Where a ray first comes within 5 mm of the surface, by sphere tracing.
  std::optional<Eigen::Vector3d> firstHit(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                          double maxRange_m) const;

 private:
  core::Trajectory trajectory_;
  core::Isometry T_vehicle_horizontal_, T_vehicle_vertical_;
  std::unique_ptr<eval::MeshQuery> world_;
};

struct PingPair {
  obs::CObservationImagingSonar::Ptr h, v;
};

/// Every `stride`-th horizontal ping with the nearest vertical one.
std::vector<PingPair> readPairs(const std::string& rawlog, std::size_t stride);

/// Figures of one configuration over many pairs.
struct StereoScore {
  std::vector<double> distances_m;  ///< points to the true surface
  std::vector<double> normalised;   ///< the same divided by the points' claimed standard deviation
  std::size_t pairs = 0, matches = 0, correct = 0;
  std::size_t patches = 0, found = 0;  ///< surface patches seen by both sonars; with a point within 0.1 m
  double seconds = 0;                  ///< of the processor in the stereo itself, preprocessing left out

  struct Point {
    Eigen::Vector3d p_world;
    sonar::StereoPoint stereo;
    double distance_m;
    double aboveTop_m;  ///< height above the topmost surface there
  };
  std::vector<Point> points;

  struct Match {
    std::size_t pair;  ///< number of the pair of pings
    sonar::Feature h, v;
    sonar::FeatureMatch match;
    /// Distance of the nearest surface points of the features' resolution cells; infinite if one holds no surface.
    double gap_m;
  };
  std::vector<Match> judged;
};

StereoScore score(const sonar::SonarOptions& options, const std::vector<PingPair>& pairs, const SurveyTruth& truth);

}  // namespace s2s::bench
