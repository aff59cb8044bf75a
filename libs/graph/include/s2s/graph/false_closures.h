#pragma once

namespace s2s::graph {

/// For tests of robustness: wrong loop closures among the true ones, as if verified, with the confidence of the best.
///
/// Three kinds in turn: a place far off; one as far off as the odometry's covariance just lets pass (a sample of it,
/// scaled to two thirds of the gate); and the same wrong shift again and again, as a quay that repeats would give.
struct FalseClosureOptions {
  double share = 0;  ///< of all candidates that are wrong; 0: none
  int seed = 1;
  double repeatedShift_m = 0.3;  ///< of the third kind, along both horizontal axes of the map
};

}  // namespace s2s::graph
