#pragma once

#include <string>

#include "s2s/core/transform.h"

namespace s2s::graph {

enum class ClosureSource {
  proximity,   ///< the estimated poses are near each other
  descriptor,  ///< the places look alike
  external,    ///< given from outside
  priorMap,    ///< registered against a map made before
  sonar,       ///< what the sonars saw on two passes
  injected     ///< wrong on purpose, see FalseClosureOptions
};

/// What became of a candidate.
enum class ClosureStatus {
  accepted,            ///< in the graph
  pending,             ///< verified, but not yet supported by another closure
  rejectedOverlap,     ///< too few points found a partner
  rejectedResidual,    ///< the clouds do not lie on each other
  rejectedDegenerate,  ///< the clouds do not determine the pose
  rejectedAmbiguous,   ///< the clouds fit in two places
  rejectedByOdometry,  ///< contradicts the odometry beyond its covariance
  rejectedByOthers,    ///< not among the largest set of closures that agree with each other
  rejectedByOptimiser  ///< contradicts the optimised graph
};

/// A relative pose between two keyframes that were visited at different times.
struct LoopClosure {
  int from = 0, to = 0;  ///< older and newer keyframe
  core::Isometry T_from_to = core::Isometry::Identity();
  core::Matrix6 covariance = core::Matrix6::Zero();  ///< body perturbation, translation before rotation
  ClosureSource source = ClosureSource::proximity;
  ClosureStatus status = ClosureStatus::pending;
  double overlap = 0;       ///< share of the newer cloud's points with a partner
  double rmse_m = 0;        ///< of the point-to-plane distances of those
  double odometryChi2 = 0;  ///< squared Mahalanobis distance to the odometry, 6 degrees of freedom
};

}  // namespace s2s::graph
