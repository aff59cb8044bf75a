#include "edge_refinement.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <optional>

namespace s2s::sonar {

namespace {

/// Returns whose ranges differ by more than this share of the range are of another surface.
constexpr double kSameSurface = 0.1;
constexpr std::size_t kMinReturns = 5;
/// A return earlier than the edge by more than this share of the range is one of something in front.
constexpr double kInFront = 0.025;
/// Length in front of a ridge that it is compared with.
constexpr double kLevelLength_m = 1.0;
/// Mean echo that an empty stretch counts as having, of 255: nothing stands out of silence by a factor.
constexpr double kLeastLevel = 20;

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

/// A stretch of bins.
struct Ridge {
  int begin = 0, end = 0;
};

class RidgeFinder {
 public:
  RidgeFinder(const PingGeometry& geometry, const LeadingEdgeOptions& options)
      : bin_m_(geometry.rangeResolution_m), options_(options) {}

  /// @param beam the samples of a beam by range
  std::optional<Ridge> find(const std::uint8_t* beam, int count, int firstBin) {
    const int length = bins(options_.ridgeLength_m);
    const int begin = firstBin + bins(options_.returnGap_m);
    if (begin + length >= count || *std::max_element(beam + begin, beam + count) <= options_.ridgeLevel)
      return std::nullopt;
    sums_.resize(static_cast<std::size_t>(count) + 1);
    sums_[0] = 0;
    for (std::size_t i = 0; i + 1 < sums_.size(); ++i) sums_[i + 1] = sums_[i] + beam[i];
    int best = -1;
    double brightest = options_.ridgeLevel;
    for (int bin = begin; bin + length <= count; ++bin) {
      const double here = mean(bin, bin + length);
      if (here <= brightest || here <= options_.ridgeContrast * levelBefore(bin, firstBin)) continue;
      brightest = here;
      best = bin;
    }
    if (best < 0) return std::nullopt;
    return grown(beam, count, best, length, 0.5 * (brightest + levelBefore(best, firstBin)));
  }

 private:
  int bins(double length_m) const { return std::max(3, static_cast<int>(std::lround(length_m / bin_m_))); }
  double mean(int from, int to) const {
    return static_cast<double>(sums_[static_cast<std::size_t>(to)] - sums_[static_cast<std::size_t>(from)]) /
           std::max(1, to - from);
  }
  /// Mean echo in front; two bins are left out, where the pulse already rises.
  double levelBefore(int bin, int firstBin) const {
    const int to = bin - 2;
    return std::max(kLeastLevel, mean(std::max(firstBin, to - bins(kLevelLength_m)), to));
  }
  /// The ridge as far as it exceeds a level.
  static Ridge grown(const std::uint8_t* beam, int count, int begin, int length, double level) {
    Ridge ridge{begin, begin + length};
    while (ridge.begin < ridge.end - 1 && beam[ridge.begin] < level) ++ridge.begin;
    while (ridge.begin > 0 && beam[ridge.begin - 1] >= level) --ridge.begin;
    while (ridge.end > ridge.begin + 1 && beam[ridge.end - 1] < level) --ridge.end;
    while (ridge.end < count && beam[ridge.end] >= level) ++ridge.end;
    return ridge;
  }

  double bin_m_;
  const LeadingEdgeOptions& options_;
  std::vector<std::uint32_t> sums_;
};

LineReturn returnOf(const Ridge& ridge, const LineReturn& first, const std::uint8_t* beam, const PingGeometry& geometry,
                    double sigma_m) {
  double weight = 0, sum = 0;
  for (int bin = ridge.begin; bin < ridge.end; ++bin) {
    weight += beam[bin];
    sum += static_cast<double>(beam[bin]) * bin;
  }
  const double length_m = (ridge.end - ridge.begin) * geometry.rangeResolution_m;
  LineReturn result = first;
  result.bin = static_cast<std::uint32_t>(ridge.begin);
  result.range_m = geometry.range_m(sum / weight);
  result.rangeSigma_m = std::hypot(sigma_m, length_m / std::sqrt(12.0));
  result.intensity = static_cast<float>(weight / (ridge.end - ridge.begin));
  result.isRidge = true;
  return result;
}

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

void addRidges(const cv::Mat& image, const PingGeometry& geometry, const LeadingEdgeOptions& options, LineScan& scan) {
  cv::Mat beams;
  cv::transpose(image, beams);
  RidgeFinder finder(geometry, options);
  std::vector<LineReturn> all;
  all.reserve(scan.returns.size() * 2);
  for (std::size_t i = 0; i < scan.returns.size();) {
    const LineReturn first = scan.returns[i];
    const auto begin = static_cast<std::ptrdiff_t>(all.size());
    for (; i < scan.returns.size() && scan.returns[i].beam == first.beam; ++i) all.push_back(scan.returns[i]);
    const auto* beam = beams.ptr<std::uint8_t>(static_cast<int>(first.beam));
    const auto ridge = finder.find(beam, beams.cols, static_cast<int>(first.bin));
    if (!ridge) continue;
    const LineReturn found = returnOf(*ridge, first, beam, geometry, first.rangeSigma_m);
    // One that began after silence is the ridge itself.
    if (std::any_of(all.begin() + begin, all.end(), [&](const LineReturn& r) {
          return std::abs(r.range_m - found.range_m) < 0.5 * options.returnGap_m;
        }))
      continue;
    all.push_back(found);
    std::sort(all.begin() + begin, all.end(), [](const auto& a, const auto& b) { return a.range_m < b.range_m; });
    std::uint8_t order = 0;
    for (auto r = all.begin() + begin; r != all.end(); ++r) r->order = order++;
  }
  scan.returns = std::move(all);
}

}  // namespace s2s::sonar
