#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "s2s/sonar/ping_geometry.h"

namespace s2s::sonar {

/// Paper, section "Leading Edge Detection": the nearest range of each beam whose intensity exceeds a threshold. The
/// defaults are the paper's.
struct LeadingEdgeOptions {
  double threshold = 80;       ///< of 255; the paper takes 80 for the Oculus and 130 for the BlueView
  double minRange_m = 0.5;     ///< nearer bins hold the transducer's ring-down
  int maxReturns = 1;          ///< more than 1 also gives surfaces behind the first
  double returnGap_m = 0.3;    ///< a further return begins after at least this length at or below the threshold
  double rangeSigma_m = 0.01;  ///< of the range of an edge, without the bin's own rounding
  double bearingSigma_rad = 0.15 * M_PI / 180.0;
  /// Speckle delays an edge: a beam's first cell may be dark by chance. The returns within this angle of a beam tell
  /// together how late that beam's is, and it is put right. 0 leaves the nearest bin as it is (the paper).
  double speckleWindow_rad = 0;
  /// A surface behind the first on a beam need not be preceded by silence: a wall behind the bed stands out of the
  /// bed's echo as a short bright ridge. If set, the brightest ridge of each beam is a further return.
  bool ridges = false;
  double ridgeLevel = 200;       ///< of 255: mean intensity that a ridge exceeds
  double ridgeContrast = 2;      ///< and how many times that of the echo in front of it
  double ridgeLength_m = 0.085;  ///< length over which that mean is taken; nothing shorter is a ridge
  /// A ridge's range is that of the straight line through all ridges within this angle of its beam, and one that lies
  /// on none is left out. 0 takes each beam's by itself.
  double ridgeWindow_rad = 0;
};

/// One leading edge of a beam.
struct LineReturn {
  std::uint32_t beam = 0;
  std::uint32_t bin = 0;
  double bearing_rad = 0;
  double range_m = 0;
  double rangeSigma_m = 0;
  float intensity = 0;     ///< preprocessed echo strength, 0..255
  std::uint8_t order = 0;  ///< 0 for the first return of its beam, 1 for the surface behind it, ...
  bool isRidge = false;    ///< its range is that of the surface's middle, not of its nearest place
};

/// Points of an arc, in the sonar's frame, from the lower to the upper edge of the aperture.
using ArcPoints = std::vector<Eigen::Vector3d>;

/// The leading edges of a ping. A return comes from anywhere on an arc over the vertical aperture; only `planePoint`
/// (the paper's) places it on the imaging plane.
struct LineScan {
  std::vector<LineReturn> returns;  ///< in order of beams, then of range
  double verticalAperture_rad = 0;
  double bearingSigma_rad = 0;
  obs::BearingModel bearingModel = obs::BearingModel::Azimuth;
  double minRange_m = 0;  ///< below it nothing was looked at
  double maxRange_m = 0;  ///< a beam without a return is free up to here
  std::size_t beamCount = 0;

  /// Paper, equation (1): the return with zero elevation, in the sonar's frame.
  Eigen::Vector3d planePoint(const LineReturn& r) const { return pointOnArc(r, 0); }
  /// The possible point of a return at an elevation, in the sonar's frame.
  Eigen::Vector3d pointOnArc(const LineReturn& r, double elevation_rad) const {
    return pointAt({r.range_m, r.bearing_rad, elevation_rad}, bearingModel);
  }
  /// `count` possible points of a return, evenly spread in elevation over the whole aperture (both edges included).
  ArcPoints arc(const LineReturn& r, std::size_t count) const;
};

/// @param image 8-bit, rows = range bins, columns = beams, as Preprocessor gives it
LineScan findLeadingEdge(const cv::Mat& image, const PingGeometry& geometry, const LeadingEdgeOptions& options);

}  // namespace s2s::sonar
