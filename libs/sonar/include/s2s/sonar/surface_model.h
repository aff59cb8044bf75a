#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <vector>

namespace s2s::sonar {

/// A feature of the horizontal sonar with the elevations that the vertical sonar offers for its range.
struct ElevationSample {
  double range_m = 0, bearing_rad = 0;
  bool known = false;            ///< false: the vertical sonar has nothing at its range
  double meanElevation_rad = 0;  ///< over its candidates, weighted by their intensity
};

struct SurfaceModelOptions {
  bool enabled = true;
  double rowLength_m = 0.06;     ///< samples are averaged over rows of this length in range
  double rowSigma = 0.01;        ///< of a row's range about the plane, as a share of the range
  double edgeSigma = 0.02;       ///< of one edge's range about the plane, as a share; to start with, then measured
  double maxEdgeScatter = 0.05;  ///< edges that scatter more are not those of one smooth surface
  double minSlope = 0.2;         ///< least |d range / d elevation| / range: below it, rows say nothing about elevation
};

/// Elevation, out of the horizontal sonar's plane, of a smooth surface as a function of range and bearing.
///
/// Why: at one range the vertical sonar shows a surface at a run of bearings, because a surface that is tilted across
/// its aperture meets that range at another elevation at each azimuth (and even a level one does, by the cosine of the
/// azimuth). Range alone cannot tell which bearing of the run belongs to which beam of the horizontal sonar. So the
/// mean elevation of each row of equal range is taken from the vertical sonar, and how the elevation varies with the
/// bearing along the row from a plane through the cluster.
class SurfaceModel {
 public:
  /// Fits the plane q . p = 1 (p in the horizontal sonar's frame) to one cluster by linear least squares. Two things
  /// are known: along a row the mean elevation is that of the vertical sonar's run at that range; and the nearest and
  /// the farthest feature at each bearing lie at the two ends of the aperture. How far from the ends exactly,
  /// thresholds and beam patterns decide, so a common offset is estimated for either end and only the slope is used.
  /// Since speckle moves them inward only, their outer quartile is fitted, either end at the weight of its own scatter.
  /// @return nothing if the cluster is too small, its edges are not those of one smooth surface, or the surface faces
  ///         the sonar so squarely that range does not tell elevation
  static std::optional<SurfaceModel> fit(const std::vector<ElevationSample>& samples, double aperture_rad,
                                         const SurfaceModelOptions& options);

  /// Nothing where no row is known or the plane is not met.
  std::optional<double> elevation(double range_m, double bearing_rad) const;

  /// The plane, in units of 1/m.
  const Eigen::Vector3d& plane() const { return q_; }
  /// Robust standard deviation of the edges about the plane, as a share of the range.
  double edgeScatter() const { return edgeScatter_; }

 private:
  struct Row {
    double meanElevation_rad = 0;       ///< from the vertical sonar
    double meanPlaneElevation_rad = 0;  ///< of the plane at the same samples
  };
  std::optional<double> planeElevation(double range_m, double bearing_rad, double near_rad) const;
  void fillRows(const std::vector<ElevationSample>& samples);
  bool isSteepEnough(double minSlope) const;

  Eigen::Vector3d q_ = Eigen::Vector3d::Zero();
  double edgeScatter_ = 0, rowLength_m_ = 0;
  std::map<long, Row> rows_;
};

}  // namespace s2s::sonar
