#pragma once

#include <mrpt/graphs/CNetworkOfPoses.h>

#include <memory>
#include <optional>
#include <vector>

#include "s2s/graph/acoustic_submap.h"
#include "s2s/graph/graph_slam_options.h"
#include "s2s/graph/keyframe.h"
#include "s2s/graph/loop_closure.h"
#include "s2s/graph/pose_graph.h"

namespace s2s::graph {

/// What a new keyframe brought about.
struct KeyframeUpdate {
  int id = 0;
  bool optimised = false;  ///< T_map_vehicle of earlier keyframes changed too
  int candidates = 0;      ///< loop closures tried
  int accepted = 0;        ///< loop closures new in the graph
};

struct GraphStatistics {
  int keyframes = 0;
  int candidates = 0, accepted = 0, pending = 0, rejected = 0;  ///< loop closures
  int submaps = 0, sonarCandidates = 0, sonarAccepted = 0;      ///< acoustic submaps, and factors between them
  SolveSummary last;                                            ///< the last optimisation
};

/// The pose graph of a survey: keyframes from the odometry, loop closures found among them, optimised poses out.
///
/// The map frame is the odometry's frame at the first keyframe (z up). Everything happens inside the calls; there are
/// no threads, and the same calls give the same result. Not safe for concurrent calls.
class GraphSlam {
 public:
  /// @param prior a map made before, in whose frame the survey shall stand once its place is found; null: none
  explicit GraphSlam(const GraphSlamOptions& options = {}, std::unique_ptr<PriorMap> prior = nullptr);
  ~GraphSlam();
  GraphSlam(GraphSlam&&) noexcept;

  /// Adds a keyframe, looks for loop closures to it and, if new ones were accepted, optimises.
  /// Keyframe times must grow; a covariance that is no covariance is replaced by the drift floor of the options.
  /// @throws core::InputError if the time does not grow or the pose is not finite
  KeyframeUpdate addKeyframe(const KeyframeInput& input);

  /// Gives a GNSS fix, in time order, not before the first keyframe. It takes part from the next optimisation on.
  void addGnss(const GnssFix& fix);

  /// Takes what the sonars saw along a piece of path that keyframes cover, pieces in order of time, and registers it to
  /// earlier passes. The factors that are believed take part from the next optimisation on.
  void addSubmap(const AcousticSubmap& submap);

  /// Offers a loop closure found elsewhere; it has to agree with odometry and other closures like any other.
  /// @throws core::InputError if a keyframe does not exist or both are the same
  ClosureStatus offerClosure(int from, int to, const core::Isometry& T_from_to, const core::Matrix6& covariance);

  /// Optimises now, with all that is known. Call it at the end of a survey.
  SolveSummary optimizeNow();

  const std::vector<Keyframe>& keyframes() const;
  const std::vector<LoopClosure>& loopClosures() const;  ///< all candidates, with what became of them
  GraphStatistics statistics() const;
  GnssReport gnssReport() const;
  RelocationReport relocationReport() const;
  /// Height of the water surface in the map frame at the last keyframe, if the waterline prior is on and was not given
  /// up because the vehicle does not float.
  std::optional<double> waterHeight_m() const;

  /// Odometry constraints and accepted closures with the optimised poses.
  PoseGraph poseGraph() const;
  mrpt::graphs::CNetworkOfPoses3DInf network() const;

  /// Covariance of a keyframe's pose in the map, given all constraints (body perturbation). The first call after a
  /// change factorises the whole graph; more calls are cheap.
  /// @returns nothing if the keyframe does not exist or the graph leaves it undetermined
  std::optional<core::Matrix6> marginalCovariance(int keyframe) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace s2s::graph
