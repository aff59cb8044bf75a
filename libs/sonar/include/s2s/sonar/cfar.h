#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace s2s::sonar {

/// How the noise level is taken from the reference cells on the near and the far side of the tested cell.
enum class CfarKind {
  SmallestOf,       ///< SOCA: the smaller of both sides' means (paper)
  CellAverage,      ///< CA: the mean of all cells
  GreatestOf,       ///< GOCA: the larger of both sides' means
  OrderedStatistic  ///< OS: the value of a given rank among all cells
};

/// Paper, table "CFAR settings". Cells are counted over both sides together, as in the paper and in StereoFLS: 16
/// reference and 8 guard cells are 8 and 4 on each side. The defaults are the horizontal sonar's.
struct CfarOptions {
  CfarKind kind = CfarKind::SmallestOf;
  int referenceCells = 16;
  int guardCells = 8;
  double falseAlarmProbability = 0.2;
  double minIntensity = 100;  ///< a detection has at least this intensity
  double orderedRank = 0.75;  ///< OrderedStatistic: rank as a share of the cells
};

/// Probability that a cell of exponential noise (a square-law detector's output) exceeds `factor` times the noise
/// level taken from `nearCells` and `farCells` cells of the same noise.
///
/// Gandhi & Kassam, "Analysis of CFAR processors in nonhomogeneous background", IEEE T-AES 24(4), 1988, extended to
/// unequal sides, which the ends of a beam have. With Y = the mean of n cells ~ Gamma(n, n):
///   CA    (1 + a / N)^-N
///   SOCA  sum_{k < n2} C(n1 + k - 1, k) n1^n1 n2^k / (a + n1 + n2)^(n1 + k) + the same with n1 and n2 exchanged
///   GOCA  CA(n1) + CA(n2) - SOCA
///   OS    prod_{i < k} (N - i) / (N - i + a)
/// A side without cells leaves the other one alone; with no cell at all the result is 0.
double cfarFalseAlarmProbability(const CfarOptions& options, double factor, int nearCells, int farCells);

/// The factor for which `cfarFalseAlarmProbability` gives `options.falseAlarmProbability`.
double cfarFactor(const CfarOptions& options, int nearCells, int farCells);

/// Part of an image: beams [firstBeam, endBeam) and bins [firstBin, endBin).
struct ImageRegion {
  int firstBeam = 0, endBeam = 0;
  int firstBin = 0, endBin = 0;
  bool empty() const { return firstBeam >= endBeam || firstBin >= endBin; }
};
ImageRegion wholeImage(const cv::Mat& image);

/// Constant-false-alarm-rate detector along range. At the ends of a beam the cells that exist are used, with the factor
/// that belongs to their number, so the rate is constant up to the ends.
class CfarDetector {
 public:
  /// @throws core::ConfigError if there are no reference cells or the probability is not within (0, 1)
  explicit CfarDetector(const CfarOptions& options = {});

  /// @param image CV_8U or CV_32F, rows = range bins, columns = beams
  /// @return CV_8U of the same size: 255 where detected, 0 elsewhere and outside `region`
  cv::Mat detect(const cv::Mat& image, const ImageRegion& region) const;
  cv::Mat detect(const cv::Mat& image) const { return detect(image, wholeImage(image)); }

  const CfarOptions& options() const { return options_; }
  /// Reference cells on one side of the tested cell.
  int cellsPerSide() const { return options_.referenceCells / 2; }
  int guardPerSide() const { return options_.guardCells / 2; }

 private:
  double factor(int nearCells, int farCells) const;

  CfarOptions options_;
  std::vector<double> factors_;  // by (nearCells, farCells)
};

}  // namespace s2s::sonar
