#pragma once

#include <vector>

#include "s2s/sonar/features.h"

namespace s2s::sonar {

/// Paper, section "Point Cloud Generation": c = [mean, variance, min, max] of a cluster's x in the horizontal frame.
struct ClusterDescriptor {
  double mean_m = 0;
  double variance_m2 = 0;
  double min_m = 0, max_m = 0;
  std::size_t size = 0;
};

/// One descriptor a cluster, by the features' labels (0 to the largest one); features labelled as noise take no part.
std::vector<ClusterDescriptor> describeClusters(const std::vector<Feature>& features);

enum class ClusterCost {
  /// Distance between [mean, standard deviation, min, max]: all four in metres, so that none outweighs the others by
  /// its
  /// unit. The variance of the paper is in square metres: for the clusters of a 10 m ping it is below 1 and would count
  /// next to nothing.
  Normalised,
  Literal  ///< the paper's: distance between [mean, variance, min, max], metres and square metres added
};

enum class ClusterPairing {
  Nearest,  ///< each horizontal cluster with the vertical cluster of least cost (paper)
  Both,     ///< the same, and each vertical cluster with the horizontal cluster of least cost
  Overlap   ///< all whose x intervals meet
};

struct ClusterAssociationOptions {
  ClusterCost cost = ClusterCost::Normalised;
  ClusterPairing pairing = ClusterPairing::Nearest;
  /// Clusters whose x intervals are further apart than this cannot show the same surface.
  double maxGap_m = 0.2;
};

struct ClusterPair {
  int horizontal = 0, vertical = 0;
  double cost = 0;
};

double clusterCost(const ClusterDescriptor& h, const ClusterDescriptor& v, ClusterCost kind);

/// Pairs in order of the horizontal, then the vertical cluster.
std::vector<ClusterPair> associateClusters(const std::vector<ClusterDescriptor>& horizontal,
                                           const std::vector<ClusterDescriptor>& vertical,
                                           const ClusterAssociationOptions& options);

}  // namespace s2s::sonar
