#pragma once

#include <vector>

#include "s2s/graph/graph_slam_options.h"
#include "s2s/graph/keyframe.h"
#include "s2s/graph/loop_closure.h"
#include "s2s/graph/odometry_chain.h"

namespace s2s::graph {

/// Everything GraphSlam knows of a survey.
struct SurveyState {
  std::vector<Keyframe> keyframes;
  std::vector<Cloud> clouds_vehicle;
  std::vector<std::optional<GravityMeasurement>> gravity;
  OdometryChain chain;
  std::vector<LoopClosure> closures;
  std::vector<LoopClosure> priorFixes;  ///< poses in a prior map: T_from_to is T_prior_vehicle of keyframe `to`
  std::vector<TiedFix> fixes;
  bool offTheWater = false;  ///< the waterline prior was given up
};

}  // namespace s2s::graph
