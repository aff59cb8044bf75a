#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "s2s/core/transform.h"
#include "s2s/sonar/cfar.h"
#include "s2s/sonar/overlap.h"
#include "s2s/sonar/ping_geometry.h"

namespace s2s::sonar {

struct FeatureOptions {
  /// Step to the immediate neighbours of a feature in the Cartesian image.
  double contextStep_m = 0.02;
  /// A beam is wider than the spacing of beams, so a thin surface lights up a short run of beams at its range. Runs up
  /// to this width give their features the bearing of the run's centre of intensity, with the standard deviation of a
  /// uniform spread over the run: the surface may also be tilted across the aperture, and then each beam of the run saw
  /// another part of it. 0 leaves every beam its own.
  double maxRunWidth_rad = 4.0 * M_PI / 180.0;
  double rangeSigma_m = 0.01;  ///< without the bin's own rounding
  double bearingSigma_rad = 0.15 * M_PI / 180.0;
};

/// A cell of a ping that CFAR detected.
struct Feature {
  std::uint32_t bin = 0, beam = 0;
  double range_m = 0;
  double beamBearing_rad = 0;   ///< of its beam
  double bearing_rad = 0;       ///< of the centre of its run of beams if that is short, else of its beam
  double bearingSigma_rad = 0;  ///< of bearing_rad
  Eigen::Vector3d p_h = Eigen::Vector3d::Zero();  ///< on its own sonar's imaging plane, in the horizontal sonar's frame
  float intensity = 0;                            ///< gamma
  float contextX = 0;  ///< mean of gamma and its two neighbours along x of its own Cartesian image
  float contextY = 0;  ///< the same along y
  int cluster = -1;
};

/// Features where `detections` is set within the overlap, in order of bins, then beams.
/// @param image      8-bit, as Preprocessor gives it
/// @param detections CV_8U as CfarDetector gives it
/// @param T_h_sonar  identity for the horizontal sonar itself
std::vector<Feature> extractFeatures(const cv::Mat& image, const cv::Mat& detections, const PingGeometry& geometry,
                                     const Overlap& overlap, const core::Isometry& T_h_sonar,
                                     const FeatureOptions& options);

/// Bilinear sample of a polar image at a point of the imaging plane (metres); 0 outside the fan.
float sampleAt(const cv::Mat& image, const PingGeometry& geometry, const Eigen::Vector2d& p);

}  // namespace s2s::sonar
