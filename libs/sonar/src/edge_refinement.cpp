#include "edge_refinement.h"

#include <algorithm>
#include <cmath>

namespace s2s::sonar {

namespace {

/// Returns whose ranges differ by more than this share of the range are of another surface.
constexpr double kSameSurface = 0.1;
constexpr std::size_t kMinReturns = 5;
/// A return earlier than the edge by more than this share of the range is one of something in front.
constexpr double kInFront = 0.025;

struct Edge {
  double bearing_rad = 0, range_m = 0;
};

/// Linear interpolation between order statistics; reorders the values.
double quantile(std::vector<double>& values, double share) {
  const double at = share * static_cast<double>(values.size() - 1);
  const auto low = values.begin() + static_cast<std::ptrdiff_t>(std::floor(at));
  std::nth_element(values.begin(), low, values.end());
  if (low + 1 == values.end()) return *low;
  const double next = *std::min_element(low + 1, values.end());
  return *low + (at - std::floor(at)) * (next - *low);
}

/// First returns around one of them.
class Neighbourhood {
 public:
  Neighbourhood(const std::vector<Edge>& edges, double window_rad) : edges_(edges), window_rad_(window_rad) {}

  /// Edges must be asked for in order.
  void moveTo(std::size_t index) {
    index_ = index;
    const double bearing_rad = edges_[index].bearing_rad;
    while (bearing_rad - edges_[first_].bearing_rad > 2 * window_rad_) ++first_;
    while (last_ < edges_.size() && edges_[last_].bearing_rad - bearing_rad <= 2 * window_rad_) ++last_;
  }

  /// Change of range with bearing, by the medians of the two halves around; they are robust, and delayed alike.
  double slope() {
    same_.clear();
    for (std::size_t i = first_; i < last_; ++i)
      if (std::abs(edges_[i].range_m - here().range_m) <= 2 * kSameSurface * here().range_m) same_.push_back(i);
    const std::size_t half = same_.size() / 2;
    if (half < kMinReturns) return 0;
    const auto middle = [&](std::size_t from, std::size_t to) {
      values_.clear();
      double bearing_rad = 0;
      for (std::size_t k = from; k < to; ++k) {
        values_.push_back(edges_[same_[k]].range_m);
        bearing_rad += edges_[same_[k]].bearing_rad;
      }
      return Edge{bearing_rad / static_cast<double>(values_.size()), quantile(values_, 0.5)};
    };
    const Edge low = middle(0, half), high = middle(half, same_.size());
    return (high.range_m - low.range_m) / (high.bearing_rad - low.bearing_rad);
  }

  /// Ranges of the same surface within the window, moved along the slope to this bearing.
  std::vector<double>& ranges(double slope) {
    values_.clear();
    for (std::size_t i = first_; i < last_; ++i) {
      const double turn_rad = edges_[i].bearing_rad - here().bearing_rad;
      const double range_m = edges_[i].range_m - slope * turn_rad;
      if (std::abs(turn_rad) <= window_rad_ && std::abs(range_m - here().range_m) < kSameSurface * here().range_m)
        values_.push_back(range_m);
    }
    return values_;
  }

 private:
  const Edge& here() const { return edges_[index_]; }

  const std::vector<Edge>& edges_;
  double window_rad_;
  std::size_t index_ = 0, first_ = 0, last_ = 0;
  std::vector<std::size_t> same_;
  std::vector<double> values_;
};

}  // namespace

void correctSpeckleDelay(double window_rad, LineScan& scan) {
  std::vector<Edge> edges;
  std::vector<LineReturn*> returns;
  for (LineReturn& r : scan.returns)
    if (r.order == 0) returns.push_back(&r);
  std::sort(returns.begin(), returns.end(),
            [](const LineReturn* a, const LineReturn* b) { return a->bearing_rad < b->bearing_rad; });
  edges.reserve(returns.size());
  for (const LineReturn* r : returns) edges.push_back({r->bearing_rad, r->range_m});
  Neighbourhood around(edges, window_rad);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    around.moveTo(i);
    std::vector<double>& ranges = around.ranges(around.slope());
    if (ranges.size() < kMinReturns) continue;
    const double q25 = quantile(ranges, 0.25), q50 = quantile(ranges, 0.5);
    const double delay_m = (q50 - q25) / std::log(1.5);
    const double edge_m = q25 - std::log(4.0 / 3.0) * delay_m;
    if (edges[i].range_m < edge_m - kInFront * edge_m) continue;
    returns[i]->range_m = edge_m;
    returns[i]->rangeSigma_m = std::hypot(returns[i]->rangeSigma_m, delay_m);
  }
}

}  // namespace s2s::sonar
