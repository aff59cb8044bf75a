#pragma once

#include "s2s/graph/cloud_registration.h"
#include "s2s/graph/consistency.h"
#include "s2s/graph/false_closures.h"
#include "s2s/graph/gnss_guest.h"
#include "s2s/graph/keyframe_policy.h"
#include "s2s/graph/optimizer.h"
#include "s2s/graph/prior_map.h"
#include "s2s/graph/scan_context.h"
#include "s2s/graph/sonar_factors.h"

namespace s2s::graph {

struct LoopSearchOptions {
  bool enabled = true;
  double minTravel_m = 25;      ///< a closure joins keyframes at least so far apart along the path
  double radius_m = 10;         ///< proximity: distance of the estimated positions
  double searchEvery_m = 2;     ///< path between two searches
  int proximityCandidates = 2;  ///< registrations a search
  int descriptorCandidates = 1;
  double submap_m = 4;  ///< path on either side of a candidate that makes up the submap to register against
};

/// A soft prior that a floating vessel stays at the water surface, whose height is estimated and may drift.
struct WaterlineOptions {
  bool enabled = false;
  double height_m = 0;         ///< vehicle origin above the surface at rest
  double sigma_m = 0.1;        ///< heave and trim
  double driftSigma_m = 0.02;  ///< change of the surface between two sections (tide)
  double section_s = 60;
  double lossWidth = 2;  ///< of the robust losses, in standard deviations; locks and wash are outliers
  /// The prior is switched off for the survey if this share of the keyframes is more than three standard deviations
  /// off after all: this vehicle does not float.
  double giveUpShare = 0.25;
};

struct GraphSlamOptions {
  KeyframePolicyOptions keyframes;
  LoopSearchOptions loops;
  ScanContextOptions places;
  RegistrationOptions registration;
  ConsistencyOptions consistency;
  OptimizerOptions optimizer;
  GnssOptions gnss;
  WaterlineOptions waterline;
  FalseClosureOptions falseClosures;
  RelocationOptions relocation;
  SonarFactorOptions sonar;

  double cloudVoxel_m = 0.4;    ///< thinning of the clouds that are kept
  int cloudPoints = 4000;       ///< and their largest size
  double closureLossWidth = 3;  ///< width of the robust (Cauchy) loss of closures in standard deviations
  /// New closures wait for a joint optimisation until one of them is this many standard deviations (of the closure)
  /// off, or so many wait.
  double optimizeAt_sigma = 3.0;
  int optimizeAtCount = 5;

  bool useGravity = true;
  /// Errors of the up direction last (they come from the accelerometer's bias), so that all keyframes of such a time
  /// together count as one measurement, and none is believed better than the floor.
  double gravityCorrelation_s = 300;
  double gravityFloor_rad = 0.001;
};

}  // namespace s2s::graph
