#include "s2s/sonar/cfar.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "s2s/core/error.h"

namespace s2s::sonar {

namespace {

/// E[exp(-a Y)] for the mean Y of n cells.
double averageProbability(double factor, int cells) { return std::pow(1.0 + factor / cells, -cells); }

/// One half of the smallest-of sum: side 1 is the smaller one.
double smallerSideProbability(double factor, int n1, int n2) {
  const double total = factor + n1 + n2;
  double term = std::pow(n1 / total, n1), sum = 0;
  for (int k = 0; k < n2; ++k) {
    sum += term;
    term *= static_cast<double>(n1 + k) / (k + 1) * (n2 / total);  // C(n1+k, k+1) / C(n1+k-1, k) = (n1+k) / (k+1)
  }
  return sum;
}

double smallestOfProbability(double factor, int n1, int n2) {
  return smallerSideProbability(factor, n1, n2) + smallerSideProbability(factor, n2, n1);
}

/// Rank from 1 of the ordered statistic among `cells` cells.
int orderedIndex(double rank, int cells) { return std::clamp(static_cast<int>(std::lround(rank * cells)), 1, cells); }

double orderedProbability(double factor, int cells, int rank) {
  double product = 1;
  for (int i = 0; i < rank; ++i) product *= (cells - i) / (cells - i + factor);
  return product;
}

/// What stays the same while a detector runs over the rows of an image.
struct Window {
  int guard, cells;  // on each side
  int rows;

  int nearBegin(int row) const { return std::max(0, row - guard - cells); }
  int nearEnd(int row) const { return std::max(0, row - guard); }
  int farBegin(int row) const { return std::min(rows, row + guard + 1); }
  int farEnd(int row) const { return std::min(rows, row + guard + cells + 1); }
};

/// Sums of the cells of both sides for a range of columns, moved along range row by row.
template <class Pixel>
class SlidingSums {
 public:
  using Sum = std::conditional_t<std::is_same_v<Pixel, std::uint8_t>, std::int32_t, double>;

  SlidingSums(const cv::Mat& image, const Window& window, const ImageRegion& region)
      : image_(image), window_(window), first_(region.firstBeam), count_(region.endBeam - region.firstBeam) {
    near_.assign(static_cast<std::size_t>(count_), 0);
    far_.assign(static_cast<std::size_t>(count_), 0);
    for (int r = window.nearBegin(region.firstBin); r < window.nearEnd(region.firstBin); ++r) add(near_, r, 1);
    for (int r = window.farBegin(region.firstBin); r < window.farEnd(region.firstBin); ++r) add(far_, r, 1);
  }

  const std::vector<Sum>& near() const { return near_; }
  const std::vector<Sum>& far() const { return far_; }

  /// From `row` to the next one.
  void advance(int row) {
    if (window_.nearEnd(row + 1) > window_.nearEnd(row)) add(near_, window_.nearEnd(row), 1);
    if (window_.nearBegin(row + 1) > window_.nearBegin(row)) add(near_, window_.nearBegin(row), -1);
    if (window_.farEnd(row + 1) > window_.farEnd(row)) add(far_, window_.farEnd(row), 1);
    if (window_.farBegin(row + 1) > window_.farBegin(row)) add(far_, window_.farBegin(row), -1);
  }

 private:
  void add(std::vector<Sum>& sums, int row, int sign) {
    const Pixel* pixels = image_.ptr<Pixel>(row) + first_;
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += sign * static_cast<Sum>(pixels[i]);
  }

  const cv::Mat& image_;
  Window window_;
  int first_, count_;
  std::vector<Sum> near_, far_;
};

/// Threshold of one column from both sides' means.
template <CfarKind kind>
float level(float nearMean, float farMean) {
  if constexpr (kind == CfarKind::SmallestOf) return std::min(nearMean, farMean);
  if constexpr (kind == CfarKind::GreatestOf) return std::max(nearMean, farMean);
  return nearMean + farMean;  // CellAverage: both come already divided by the total number
}

template <class Pixel, CfarKind kind, class Sum>
void testRow(const Pixel* pixels, const std::vector<Sum>& near, const std::vector<Sum>& far, float nearScale,
             float farScale, float minIntensity, std::uint8_t* out) {
  for (std::size_t i = 0; i < near.size(); ++i) {
    const float limit = level<kind>(static_cast<float>(near[i]) * nearScale, static_cast<float>(far[i]) * farScale);
    const auto value = static_cast<float>(pixels[i]);
    out[i] = (value > limit) & (value >= minIntensity) ? 255 : 0;
  }
}

template <class Pixel, CfarKind kind, class Factor>
void detectByMeans(const cv::Mat& image, const Window& window, const ImageRegion& region, double minIntensity,
                   const Factor& factor, cv::Mat& out) {
  SlidingSums<Pixel> sums(image, window, region);
  for (int row = region.firstBin; row < region.endBin; ++row) {
    const int n1 = window.nearEnd(row) - window.nearBegin(row), n2 = window.farEnd(row) - window.farBegin(row);
    const double a = factor(n1, n2);
    if (n1 + n2 > 0) {
      // A side without cells takes no part: the other one stands for both.
      const bool average = kind == CfarKind::CellAverage;
      const auto nearScale = static_cast<float>(n1 == 0 ? 0 : a / (average ? n1 + n2 : n1));
      const auto farScale = static_cast<float>(n2 == 0 ? 0 : a / (average ? n1 + n2 : n2));
      const auto& near = n1 == 0 && !average ? sums.far() : sums.near();
      const auto& far = n2 == 0 && !average ? sums.near() : sums.far();
      testRow<Pixel, kind>(image.ptr<Pixel>(row) + region.firstBeam, near, far,
                           n1 == 0 && !average ? farScale : nearScale, n2 == 0 && !average ? nearScale : farScale,
                           static_cast<float>(minIntensity), out.ptr<std::uint8_t>(row) + region.firstBeam);
    }
    sums.advance(row);
  }
}

template <class Pixel, class Factor>
void detectByRank(const cv::Mat& image, const Window& window, const ImageRegion& region, const CfarOptions& options,
                  const Factor& factor, cv::Mat& out) {
  std::vector<Pixel> cells;
  for (int row = region.firstBin; row < region.endBin; ++row)
    for (int column = region.firstBeam; column < region.endBeam; ++column) {
      cells.clear();
      for (int r = window.nearBegin(row); r < window.nearEnd(row); ++r) cells.push_back(image.at<Pixel>(r, column));
      const auto n1 = static_cast<int>(cells.size());
      for (int r = window.farBegin(row); r < window.farEnd(row); ++r) cells.push_back(image.at<Pixel>(r, column));
      if (cells.empty()) continue;
      const auto total = static_cast<int>(cells.size());
      const auto rank = cells.begin() + (orderedIndex(options.orderedRank, total) - 1);
      std::nth_element(cells.begin(), rank, cells.end());
      const double value = image.at<Pixel>(row, column);
      if (value > factor(n1, total - n1) * static_cast<double>(*rank) && value >= options.minIntensity)
        out.at<std::uint8_t>(row, column) = 255;
    }
}

template <class Pixel, class Factor>
void detectIn(const cv::Mat& image, const Window& window, const ImageRegion& region, const CfarOptions& options,
              const Factor& factor, cv::Mat& out) {
  const double least = options.minIntensity;
  switch (options.kind) {
    case CfarKind::SmallestOf:
      return detectByMeans<Pixel, CfarKind::SmallestOf>(image, window, region, least, factor, out);
    case CfarKind::CellAverage:
      return detectByMeans<Pixel, CfarKind::CellAverage>(image, window, region, least, factor, out);
    case CfarKind::GreatestOf:
      return detectByMeans<Pixel, CfarKind::GreatestOf>(image, window, region, least, factor, out);
    case CfarKind::OrderedStatistic:
      return detectByRank<Pixel>(image, window, region, options, factor, out);
  }
}

}  // namespace

double cfarFalseAlarmProbability(const CfarOptions& options, double factor, int nearCells, int farCells) {
  const int total = nearCells + farCells;
  if (total == 0) return 0;
  if (options.kind == CfarKind::OrderedStatistic)
    return orderedProbability(factor, total, orderedIndex(options.orderedRank, total));
  if (options.kind == CfarKind::CellAverage || nearCells == 0 || farCells == 0)
    return averageProbability(factor, total);
  const double smallest = smallestOfProbability(factor, nearCells, farCells);
  if (options.kind == CfarKind::SmallestOf) return smallest;
  return averageProbability(factor, nearCells) + averageProbability(factor, farCells) - smallest;
}

double cfarFactor(const CfarOptions& options, int nearCells, int farCells) {
  if (nearCells + farCells == 0) return 0;
  const auto excess = [&](double factor) {
    return cfarFalseAlarmProbability(options, factor, nearCells, farCells) - options.falseAlarmProbability;
  };
  double low = 0, high = 1;
  while (excess(high) > 0 && high < 1e12) high *= 2;
  for (int i = 0; i < 100 && high - low > 1e-12 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (excess(middle) > 0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

ImageRegion wholeImage(const cv::Mat& image) { return {0, image.cols, 0, image.rows}; }

CfarDetector::CfarDetector(const CfarOptions& options) : options_(options) {
  if (options_.referenceCells < 2 || options_.guardCells < 0)
    throw core::ConfigError("CFAR needs at least 2 reference cells and no negative number of guard cells", "sonar CFAR",
                            "give e.g. 16 reference and 8 guard cells, counted over both sides");
  if (options_.falseAlarmProbability <= 0 || options_.falseAlarmProbability >= 1)
    throw core::ConfigError("the CFAR false-alarm probability is not within 0..1", "sonar CFAR", "give e.g. 0.2");
  for (int near = 0; near <= cellsPerSide(); ++near)
    for (int far = 0; far <= cellsPerSide(); ++far) factors_.push_back(cfarFactor(options_, near, far));
}

double CfarDetector::factor(int nearCells, int farCells) const {
  return factors_[static_cast<std::size_t>(nearCells) * static_cast<std::size_t>(cellsPerSide() + 1) +
                  static_cast<std::size_t>(farCells)];
}

cv::Mat CfarDetector::detect(const cv::Mat& image, const ImageRegion& region) const {
  cv::Mat out = cv::Mat::zeros(image.size(), CV_8U);
  if (image.empty() || region.empty()) return out;
  const Window window{guardPerSide(), cellsPerSide(), image.rows};
  const auto byCells = [this](int near, int far) { return factor(near, far); };
  if (image.depth() == CV_8U)
    detectIn<std::uint8_t>(image, window, region, options_, byCells, out);
  else
    detectIn<float>(image, window, region, options_, byCells, out);
  return out;
}

}  // namespace s2s::sonar
