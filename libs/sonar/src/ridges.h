#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "s2s/sonar/leading_edge.h"

namespace s2s::sonar {

/// A ridge on one beam: a stretch of bins that stands out of what is in front of it.
struct Ridge {
  std::size_t beam = 0;
  int begin = 0, end = 0;  ///< bins
  double centre = 0;       ///< fractional bin of its centre of intensity
  float level = 0;         ///< mean intensity
};

/// The brightest ridge behind each beam's first return, by beam; beams without one are missing.
/// @param beams the image transposed: a row for each beam
std::vector<Ridge> findRidges(const cv::Mat& beams, const PingGeometry& geometry, const LeadingEdgeOptions& options,
                              const std::vector<LineReturn>& returns);

/// Adds the ridge behind each beam's first return, and numbers the returns of each beam anew.
///
/// With `ridgeWindow_rad` its range is that of the straight line through its neighbourhood (see `RidgeLines`), and one
/// that lies on no such line is left out; else it is the range of its middle.
void addRidges(const cv::Mat& image, const PingGeometry& geometry, const LeadingEdgeOptions& options, LineScan& scan);

}  // namespace s2s::sonar
