#include "s2s/sonar/leading_edge.h"

#include <algorithm>
#include <cmath>

#include "edge_refinement.h"
#include "ridges.h"

namespace s2s::sonar {

namespace {

constexpr int kNone = -1;

/// First bin of each beam above the threshold, or kNone. Row by row, because images are stored so.
std::vector<int> firstBins(const cv::Mat& image, int firstRow, std::uint8_t threshold) {
  const auto beams = static_cast<std::size_t>(image.cols);
  std::vector<int> bins(beams, kNone);
  std::size_t missing = beams;
  for (int row = firstRow; row < image.rows && missing > 0; ++row) {
    const auto* pixels = image.ptr<std::uint8_t>(row);
    std::uint8_t strongest = 0;  // most rows before the edge hold nothing: one fast pass tells
    for (std::size_t beam = 0; beam < beams; ++beam) strongest = std::max(strongest, pixels[beam]);
    if (strongest <= threshold) continue;
    for (std::size_t beam = 0; beam < beams; ++beam) {
      if (pixels[beam] <= threshold || bins[beam] != kNone) continue;
      bins[beam] = row;
      --missing;
    }
  }
  return bins;
}

/// The next bin above the threshold after a gap of at least `gapBins` bins at or below it, or kNone.
int nextBin(const cv::Mat& image, int beam, int after, int gapBins, std::uint8_t threshold) {
  int quiet = 0;
  for (int row = after + 1; row < image.rows; ++row) {
    const bool above = image.at<std::uint8_t>(row, beam) > threshold;
    if (above && quiet >= gapBins) return row;
    quiet = above ? 0 : quiet + 1;
  }
  return kNone;
}

}  // namespace

ArcPoints LineScan::arc(const LineReturn& r, std::size_t count) const {
  ArcPoints points(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double u = count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) - 0.5 : 0.0;
    points[i] = pointOnArc(r, u * verticalAperture_rad);
  }
  return points;
}

LineScan findLeadingEdge(const cv::Mat& image, const PingGeometry& geometry, const LeadingEdgeOptions& options) {
  LineScan scan;
  scan.verticalAperture_rad = geometry.verticalAperture_rad;
  scan.bearingSigma_rad = options.bearingSigma_rad;
  scan.bearingModel = geometry.bearingModel;
  scan.minRange_m = options.minRange_m;
  scan.maxRange_m = geometry.maxRange_m();
  scan.beamCount = geometry.beamCount();
  if (image.empty()) return scan;

  const double bin_m = geometry.rangeResolution_m;
  const auto threshold = static_cast<std::uint8_t>(std::clamp(std::floor(options.threshold), 0.0, 255.0));
  const int firstRow = std::max(0, static_cast<int>(std::ceil(geometry.binAt(options.minRange_m))));
  const int gapBins = std::max(1, static_cast<int>(std::ceil(options.returnGap_m / bin_m)));
  const double sigma_m = std::sqrt(options.rangeSigma_m * options.rangeSigma_m + bin_m * bin_m / 12.0);

  const std::vector<int> first = firstBins(image, firstRow, threshold);
  for (std::size_t beam = 0; beam < first.size(); ++beam) {
    int bin = first[beam];
    for (int order = 0; bin != kNone; ++order) {
      const auto column = static_cast<int>(beam);
      scan.returns.push_back({static_cast<std::uint32_t>(beam), static_cast<std::uint32_t>(bin),
                              geometry.bearings_rad[beam], geometry.range_m(bin), sigma_m,
                              static_cast<float>(image.at<std::uint8_t>(bin, column)), static_cast<std::uint8_t>(order),
                              false});
      bin = order + 1 < options.maxReturns ? nextBin(image, column, bin, gapBins, threshold) : kNone;
    }
  }
  if (options.ridges) addRidges(image, geometry, options, scan);
  if (options.speckleWindow_rad > 0) correctSpeckleDelay(options.speckleWindow_rad, scan);
  return scan;
}

}  // namespace s2s::sonar
