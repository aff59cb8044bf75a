#pragma once

#include <vector>

#include "s2s/sonar/feature_association.h"

namespace s2s::sonar {

/// A possible match with what the ambiguity test needs.
struct Candidate {
  int horizontal, vertical;
  float cost;
  float elevation_rad;  ///< position along the horizontal feature's arc
};

/// All pairs of features of associated clusters that pass the gates, in order of the horizontal feature.
std::vector<Candidate> findCandidates(const std::vector<Feature>& horizontal, const std::vector<Feature>& vertical,
                                      const std::vector<ClusterPair>& pairs, const PairGeometry& geometry,
                                      const FeatureAssociationOptions& options);

}  // namespace s2s::sonar
