#include "ridges.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "ridge_lines.h"

namespace s2s::sonar {

namespace {

/// Length in front of a ridge that it is compared with.
constexpr double kLevelLength_m = 1.0;
/// Mean echo that an empty stretch counts as having, of 255: nothing stands out of silence by a factor.
constexpr double kLeastLevel = 20;

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
    Ridge ridge;
    ridge.begin = begin;
    ridge.end = begin + length;
    while (ridge.begin < ridge.end - 1 && beam[ridge.begin] < level) ++ridge.begin;
    while (ridge.begin > 0 && beam[ridge.begin - 1] >= level) --ridge.begin;
    while (ridge.end > ridge.begin + 1 && beam[ridge.end - 1] < level) --ridge.end;
    while (ridge.end < count && beam[ridge.end] >= level) ++ridge.end;
    double weight = 0, sum = 0;
    for (int bin = ridge.begin; bin < ridge.end; ++bin) {
      weight += beam[bin];
      sum += static_cast<double>(beam[bin]) * bin;
    }
    ridge.centre = sum / weight;
    ridge.level = static_cast<float>(weight / (ridge.end - ridge.begin));
    return ridge;
  }

  double bin_m_;
  const LeadingEdgeOptions& options_;
  std::vector<std::uint32_t> sums_;
};

LineReturn returnOf(const Ridge& ridge, const LineReturn& first, const PingGeometry& geometry) {
  const double length_m = (ridge.end - ridge.begin) * geometry.rangeResolution_m;
  LineReturn result = first;
  result.bin = static_cast<std::uint32_t>(ridge.begin);
  result.range_m = geometry.range_m(ridge.centre);
  result.rangeSigma_m = std::hypot(first.rangeSigma_m, length_m / std::sqrt(12.0));
  result.intensity = ridge.level;
  result.isRidge = true;
  return result;
}

/// Enters a return among those of its beam, by range, and numbers them anew; not if one is there already.
void enter(const LineReturn& found, double apart_m, std::ptrdiff_t begin, std::vector<LineReturn>& all) {
  if (std::any_of(all.begin() + begin, all.end(),
                  [&](const LineReturn& r) { return std::abs(r.range_m - found.range_m) < apart_m; }))
    return;
  all.push_back(found);
  std::sort(all.begin() + begin, all.end(), [](const auto& a, const auto& b) { return a.range_m < b.range_m; });
  std::uint8_t order = 0;
  for (auto r = all.begin() + begin; r != all.end(); ++r) r->order = order++;
}

}  // namespace

std::vector<Ridge> findRidges(const cv::Mat& beams, const PingGeometry& geometry, const LeadingEdgeOptions& options,
                              const std::vector<LineReturn>& returns) {
  RidgeFinder finder(geometry, options);
  std::vector<Ridge> ridges;
  for (const LineReturn& r : returns) {
    if (r.order > 0) continue;
    auto ridge = finder.find(beams.ptr<std::uint8_t>(static_cast<int>(r.beam)), beams.cols, static_cast<int>(r.bin));
    if (!ridge) continue;
    ridge->beam = r.beam;
    ridges.push_back(*ridge);
  }
  return ridges;
}

void addRidges(const cv::Mat& image, const PingGeometry& geometry, const LeadingEdgeOptions& options, LineScan& scan) {
  cv::Mat beams;
  cv::transpose(image, beams);
  const std::vector<Ridge> ridges = findRidges(beams, geometry, options, scan.returns);
  const RidgeLines lines(ridges, beams, geometry);
  std::vector<LineReturn> all;
  all.reserve(scan.returns.size() + ridges.size());
  auto ridge = ridges.begin();
  for (std::size_t i = 0; i < scan.returns.size();) {
    const LineReturn first = scan.returns[i];
    const auto begin = static_cast<std::ptrdiff_t>(all.size());
    for (; i < scan.returns.size() && scan.returns[i].beam == first.beam; ++i) all.push_back(scan.returns[i]);
    if (ridge == ridges.end() || ridge->beam != first.beam) continue;
    LineReturn found = returnOf(*ridge, first, geometry);
    const auto range = options.ridgeWindow_rad > 0 ? lines.at(*ridge, options.ridgeWindow_rad) : std::nullopt;
    ++ridge;
    if (range) {
      found.range_m = range->range_m;
      found.rangeSigma_m = std::hypot(first.rangeSigma_m, range->sigma_m);
    }
    // One that began after silence is the ridge itself.
    if (range || options.ridgeWindow_rad <= 0) enter(found, 0.5 * options.returnGap_m, begin, all);
  }
  scan.returns = std::move(all);
}

}  // namespace s2s::sonar
