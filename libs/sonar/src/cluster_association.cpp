#include "s2s/sonar/cluster_association.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

namespace s2s::sonar {

namespace {

double gap_m(const ClusterDescriptor& a, const ClusterDescriptor& b) {
  return std::max(a.min_m, b.min_m) - std::min(a.max_m, b.max_m);
}

/// The cluster of `others` with the least cost among those near enough; -1 if there is none.
int nearestTo(const ClusterDescriptor& cluster, const std::vector<ClusterDescriptor>& others,
              const ClusterAssociationOptions& options) {
  int best = -1;
  double bestCost = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < others.size(); ++i) {
    if (gap_m(cluster, others[i]) > options.maxGap_m) continue;
    const double cost = clusterCost(cluster, others[i], options.cost);
    if (cost >= bestCost) continue;
    bestCost = cost;
    best = static_cast<int>(i);
  }
  return best;
}

}  // namespace

std::vector<ClusterDescriptor> describeClusters(const std::vector<Feature>& features) {
  std::vector<ClusterDescriptor> clusters;
  for (const Feature& f : features) {
    if (f.cluster < 0) continue;
    if (static_cast<std::size_t>(f.cluster) >= clusters.size())
      clusters.resize(static_cast<std::size_t>(f.cluster) + 1);
    ClusterDescriptor& c = clusters[static_cast<std::size_t>(f.cluster)];
    const double x = f.p_h.x();
    c.min_m = c.size == 0 ? x : std::min(c.min_m, x);
    c.max_m = c.size == 0 ? x : std::max(c.max_m, x);
    ++c.size;
    const double delta = x - c.mean_m;  // Welford's update: variance_m2 holds the sum of squares until the end
    c.mean_m += delta / static_cast<double>(c.size);
    c.variance_m2 += delta * (x - c.mean_m);
  }
  for (ClusterDescriptor& c : clusters)
    if (c.size > 0) c.variance_m2 /= static_cast<double>(c.size);
  return clusters;
}

double clusterCost(const ClusterDescriptor& h, const ClusterDescriptor& v, ClusterCost kind) {
  const double spread = kind == ClusterCost::Literal ? h.variance_m2 - v.variance_m2
                                                     : std::sqrt(h.variance_m2) - std::sqrt(v.variance_m2);
  return std::hypot(std::hypot(h.mean_m - v.mean_m, spread), std::hypot(h.min_m - v.min_m, h.max_m - v.max_m));
}

std::vector<ClusterPair> associateClusters(const std::vector<ClusterDescriptor>& horizontal,
                                           const std::vector<ClusterDescriptor>& vertical,
                                           const ClusterAssociationOptions& options) {
  std::set<std::pair<int, int>> pairs;
  if (options.pairing == ClusterPairing::Overlap) {
    for (std::size_t h = 0; h < horizontal.size(); ++h)
      for (std::size_t v = 0; v < vertical.size(); ++v)
        if (gap_m(horizontal[h], vertical[v]) <= options.maxGap_m)
          pairs.emplace(static_cast<int>(h), static_cast<int>(v));
  } else {
    for (std::size_t h = 0; h < horizontal.size(); ++h)
      pairs.emplace(static_cast<int>(h), nearestTo(horizontal[h], vertical, options));
    if (options.pairing == ClusterPairing::Both)
      for (std::size_t v = 0; v < vertical.size(); ++v)
        pairs.emplace(nearestTo(vertical[v], horizontal, options), static_cast<int>(v));
  }
  std::vector<ClusterPair> result;
  for (const auto& [h, v] : pairs)
    if (h >= 0 && v >= 0)
      result.push_back(
          {h, v,
           clusterCost(horizontal[static_cast<std::size_t>(h)], vertical[static_cast<std::size_t>(v)], options.cost)});
  return result;
}

}  // namespace s2s::sonar
