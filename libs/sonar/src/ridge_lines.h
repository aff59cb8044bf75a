#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "ridges.h"

namespace s2s::sonar {

/// The ridges of one ping as straight lines in the imaging plane.
///
/// A beam is wide enough for its flanks to see an inclined wall nearer and farther than its middle does, so that a
/// beam's ridge is long; and where the flanks do not see alike, because the wall begins there behind the bed, its
/// middle is off by some centimetres, for all beams of the neighbourhood alike. Range cells are sharp. So the places of
/// a ridge are taken along the beams: of each run of beams that share a ridge at one range the centre of intensity in
/// bearing. A surface that faces the sonar gives runs much wider than long; there the middles along the beams are
/// good. Runs cut off by the end of the fan are not used.
class RidgeLines {
 public:
  /// @param ridges by beam
  RidgeLines(const std::vector<Ridge>& ridges, const cv::Mat& beams, const PingGeometry& geometry);

  struct Range {
    double range_m = 0;
    double sigma_m = 0;
  };
  /// Where the line through the places within `window_rad` of the ridge's bearing crosses its beam: a robust fit
  /// (Tukey's weights), the standard deviation by the scatter about it, its correlation and its leverage. Nothing if
  /// there is no line, if it passes by the ridge, or if it tells less than the ridge's own length.
  std::optional<Range> at(const Ridge& ridge, double window_rad) const;

 private:
  struct Place {
    double bearing_rad = 0;
    Eigen::Vector2d p = Eigen::Vector2d::Zero();  ///< in the imaging plane
  };
  void add(double bearing_rad, double range_m);
  /// The middles along their beams of those ridges of a run that lie at its range.
  void addMiddles(const std::vector<Ridge>& ridges, int bin, std::size_t first, std::size_t last);

  const PingGeometry& geometry_;
  std::vector<Place> places_;  ///< by bearing
};

}  // namespace s2s::sonar
