#pragma once

#include <cstdint>
#include <map>
#include <unordered_map>

#include "s2s/core/time.h"
#include "s2s/eval/statistics.h"
#include "s2s/products/height_grid.h"

namespace s2s::eval {

struct PassDifferenceOptions {
  double gap_s = 30;      ///< soundings of a cell further apart in time belong to different passes
  int minPoints = 5;      ///< soundings a pass needs in a cell
  double window_m = 0.5;  ///< soundings further than this from the grid's height are no seabed
};

/// Heights of later passes minus those of earlier ones over the same cells: a survey's crossline check, without truth.
struct PassDifference {
  std::size_t cells = 0;        ///< seen by more than one pass
  std::size_t differences = 0;  ///< between successive passes
  double mean_m = 0;
  double std_m = 0;
  double p95_m = 0;  ///< 95th percentile of the magnitude
};

/// Sorts soundings to cells and passes. A cell is seen in slots of 10 s; slots without a gap of `gap_s` between them
/// are one pass, and its height is the mean of its soundings.
class PassComparison {
 public:
  /// @param grid must live longer than this
  PassComparison(const products::HeightGrid& grid, const PassDifferenceOptions& options)
      : grid_(grid), options_(options) {}

  /// A sounding of a sonar layer, in the grid's frame.
  void add(const Eigen::Vector3d& p, double time_s);

  PassDifference result() const;

 private:
  struct Slot {
    std::uint32_t count = 0;
    double sum_m = 0;
  };
  using Slots = std::map<std::int64_t, Slot>;  ///< by number of the 10 s
  std::vector<double> passHeights(const Slots& slots) const;

  const products::HeightGrid& grid_;
  PassDifferenceOptions options_;
  std::unordered_map<std::size_t, Slots> cells_;
};

}  // namespace s2s::eval
