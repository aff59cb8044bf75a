#pragma once

#include <vector>

#include "s2s/core/transform.h"
#include "s2s/sonar/assignment.h"
#include "s2s/sonar/cluster_association.h"
#include "s2s/sonar/features.h"
#include "s2s/sonar/surface_model.h"

namespace s2s::sonar {

enum class FeatureCost {
  /// (range misfit / sigma)^2 of the pair's intersection, plus the squared difference of the standardised intensity
  /// context at a small weight: all terms are pure numbers.
  Geometric,
  /// The paper's: distance between [x, gamma, gamma_x, gamma_y] and [x, gamma, gamma_y, gamma_x], metres and grey
  /// levels
  /// (0..255) added. The grey levels decide; x hardly counts.
  Literal
};

enum class AmbiguityRule {
  Ignore,  ///< take the assignment as it is
  Keep,    ///< enlarge the covariance by the spread of the candidates
  Reject   ///< drop features whose candidates are too far apart
};

struct FeatureAssociationOptions {
  FeatureCost cost = FeatureCost::Geometric;
  double maxResidual = 3.0;       ///< Geometric: gate on |range misfit| / sigma
  double intensityWeight = 0.25;  ///< Geometric: of the squared difference of standardised intensities
  /// Points may lie outside an aperture by this. Hardly anything is heard there: a feature of the one sonar just
  /// outside the other's aperture has no partner and takes another's.
  double apertureMargin_rad = 0;
  double maxCost = 5.0;        ///< Geometric: gate on the whole cost
  int literalNeighbours = 16;  ///< Literal: candidates kept for each horizontal feature
  AmbiguityRule ambiguity = AmbiguityRule::Reject;
  double ambiguityCost = 4.0;  ///< candidates within this cost of the best are almost as good
  double maxSpread_m = 0.2;    ///< Reject: allowed distance between such candidates' points, 0.1 m about their middle
  /// Geometric: a smooth surface tells which of the vertical sonar's bearings at one range belongs to which beam.
  SurfaceModelOptions surface;
  double surfaceSigma_rad = 0.5 * M_PI / 180.0;  ///< elevations off the surface by this cost one unit
  AssignmentOptions assignment;
};

/// A pair of features that show the same piece of surface.
struct FeatureMatch {
  std::size_t horizontal = 0, vertical = 0;  ///< indices of the features
  double cost = 0;
  double bearing_v_rad = 0, bearingSigma_v_rad = 0;  ///< what the vertical sonar is taken to have measured
  /// Standard deviation, along the horizontal feature's arc, of the points of the candidates that are almost as good.
  double spread_m = 0;
};

struct FeatureAssociation {
  std::vector<FeatureMatch> matches;  ///< in order of the horizontal features; no feature stands twice
  std::size_t candidates = 0;         ///< pairs that passed the gates
  std::size_t ambiguous = 0;          ///< horizontal features rejected as ambiguous
  std::size_t surfaces = 0;           ///< horizontal clusters that a smooth surface was fitted to
  double cost = 0, lowerBound = 0;    ///< of the assignment
};

/// What the association must know of the two pings besides the features.
struct PairGeometry {
  core::Isometry T_h_v = core::Isometry::Identity();
  obs::BearingModel model_h = obs::BearingModel::Azimuth, model_v = obs::BearingModel::Azimuth;
  double aperture_h_rad = 0, aperture_v_rad = 0;
  double rangeSigma_h_m = 0.01, rangeSigma_v_m = 0.01;  ///< of the features' ranges, bins included
};

/// Matches features one to one within the associated clusters.
FeatureAssociation associateFeatures(const std::vector<Feature>& horizontal, const std::vector<Feature>& vertical,
                                     const std::vector<ClusterPair>& clusterPairs, const PairGeometry& geometry,
                                     const FeatureAssociationOptions& options);

}  // namespace s2s::sonar
