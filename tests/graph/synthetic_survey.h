#pragma once

#include <vector>

#include "fixed_random.h"
#include "s2s/graph/graph_slam.h"

namespace s2s::graph::test {

/// A survey whose truth is known: laps of a rectangle, keyframes 1 m apart, odometry with white noise on every step.
struct SyntheticSurvey {
  std::vector<core::Isometry> truth, odometry;
  core::Matrix6 stepCovariance;
};

SyntheticSurvey makeLaps(int laps, double length_m, double width_m, unsigned seed);

/// Keyframes at 1 s intervals.
KeyframeInput keyframeInput(const SyntheticSurvey& survey, std::size_t k);

/// Root mean square distance between estimate and truth, both from the first keyframe on.
double rmsError_m(const GraphSlam& slam, const SyntheticSurvey& survey);

/// A town of houses on patches of ground around the path: what a scanner at a pose sees within `range_m` (no
/// occlusion), with 1 cm of noise. The same seed gives the same town.
class SyntheticTown {
 public:
  SyntheticTown(double length_m, double width_m, unsigned seed);
  Cloud scan(const core::Isometry& T_map_vehicle, double range_m, FixedRandom& random) const;

 private:
  void addWall(const Eigen::Vector3d& corner, const Eigen::Vector3d& along, double height_m, FixedRandom& random);
  void addGround(const Eigen::Vector3d& corner, const Eigen::Vector3d& u, const Eigen::Vector3d& v,
                 FixedRandom& random);
  std::vector<Eigen::Vector3d> points_map_;
};

}  // namespace s2s::graph::test
