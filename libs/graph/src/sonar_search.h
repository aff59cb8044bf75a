#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "s2s/graph/acoustic_registration.h"
#include "survey_state.h"

namespace s2s::graph {

/// Finds places that the sonars saw before, and registers to them.
class SonarSearch {
 public:
  explicit SonarSearch(const SonarFactorOptions& options) : options_(options) {}

  /// Takes a submap and returns its registrations to earlier passes: pending if they fit.
  std::vector<LoopClosure> add(const SurveyState& state, const AcousticSubmap& submap);
  int submapCount() const { return static_cast<int>(submaps_.size()); }

 private:
  using Cell = std::pair<std::int32_t, std::int32_t>;
  struct Submap {
    int keyframe = 0;                      ///< in whose vehicle frame the points are
    AcousticCloud stereo, swath;           ///< thinned
    std::vector<Cell> cells;               ///< of the horizontal plane, sorted
    std::vector<Eigen::Vector3d> samples;  ///< a place in each cell
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  };
  struct Candidate {
    std::size_t submap = 0;
    double area_m2 = 0;  ///< common
  };

  Submap prepared(const SurveyState& state, const AcousticSubmap& submap) const;
  void describe(Submap& submap) const;
  Cell cellOf(const Eigen::Vector3d& p) const;
  double commonArea_m2(const Submap& target, const Submap& source, const core::Isometry& T_target_source) const;
  std::vector<Candidate> candidates(const SurveyState& state) const;
  LoopClosure registerTo(const SurveyState& state, const Submap& target);
  /// True if the odometry cannot have compared stereo points at the newer keyframe with those at the older one.
  bool isForgotten(const SurveyState& state, int older, int newer) const;
  struct JoinedTarget;
  const JoinedTarget& joinedAround(const SurveyState& state, const Submap& submap);

  SonarFactorOptions options_;
  std::vector<Submap> submaps_;
  std::map<int, std::shared_ptr<JoinedTarget>> joined_;  ///< the last few, by keyframe
};

}  // namespace s2s::graph
