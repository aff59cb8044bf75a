#pragma once

#include <cstdint>
#include <vector>

#include "s2s/graph/loop_closure.h"
#include "s2s/graph/odometry_chain.h"

namespace s2s::graph {

struct ConsistencyOptions {
  /// Largest squared Mahalanobis distance (6 degrees of freedom) between a closure and the odometry, and between two
  /// closures along the odometry that joins them; 22.5 is the 99.9 % quantile.
  double chi2 = 22.5;
  /// Closures between the same two stretches of path that must agree before the first of them is believed. Far apart
  /// almost any two agree, since the odometry between them leaves room; side by side hardly two wrong ones do.
  int minSupport = 3;
  double stretch_m = 20;  ///< largest distance along the path between both ends of two such closures
  /// Drift of the odometry per metre travelled that is assumed beyond its own covariance (random walk).
  double driftTranslation_m = 0.004;
  double driftRotation_rad = 0.0002;
};

/// Squared Mahalanobis distance of a closure to the odometry.
double odometryChi2(const OdometryChain& chain, const LoopClosure& closure);
/// Squared Mahalanobis distance from the identity of the loop a.from -> a.to -> b.to -> b.from -> a.from.
double pairChi2(const OdometryChain& chain, const LoopClosure& a, const LoopClosure& b);

/// Keeps the closures that agree with each other: pairwise consistency maximisation (Mangelson et al., "Pairwise
/// Consistent Measurement Set Maximization", ICRA 2018), grown closure by closure. The largest clique is sought
/// greedily: from the new closure with each one that comes, from many starts after a ban. Of that clique only those are
/// chosen that have support side by side.
class ConsistencySet {
 public:
  explicit ConsistencySet(const ConsistencyOptions& options) : options_(options) {}

  /// Adds a verified closure and returns its number.
  int add(const OdometryChain& chain, const LoopClosure& closure);
  /// Takes a closure out of the choice for good.
  void ban(int number) { banned_[number] = true; }

  /// True for each closure that is believed.
  const std::vector<bool>& chosen() const { return chosen_; }
  /// True for each closure that agrees with all chosen ones but still lacks support.
  const std::vector<bool>& waiting() const { return waiting_; }
  /// Chooses anew among all that are not banned.
  void choose();

 private:
  using Row = std::vector<std::uint64_t>;
  std::vector<int> grow(int seed, const std::vector<int>& order) const;
  std::vector<int> byAgreement() const;
  void take(std::vector<int> clique);

  ConsistencyOptions options_;
  std::vector<LoopClosure> closures_;
  std::vector<Row> agrees_, beside_;  ///< beside: agree and join the same stretches
  std::vector<bool> banned_, chosen_, waiting_;
  std::vector<int> best_;  ///< the largest set found, chosen or still without support
};

}  // namespace s2s::graph
