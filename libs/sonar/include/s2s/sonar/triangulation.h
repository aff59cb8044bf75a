#pragma once

#include <Eigen/Core>
#include <optional>

#include "s2s/core/transform.h"
#include "s2s/obs/CObservationImagingSonar.h"

namespace s2s::sonar {

/// How a matched pair becomes a point.
enum class Fusion {
  Average,     ///< the paper's last equation read literally: all three coordinates averaged, zeros included
  Coordinate,  ///< each sonar gives the coordinates of its own imaging plane, shared ones are averaged
  Exact        ///< least squares over both ranges and both bearings
};

/// What one sonar measured of a feature, and how well.
struct BeamMeasurement {
  double range_m = 0;
  double bearing_rad = 0;
  double rangeSigma_m = 0.01;
  double bearingSigma_rad = 0.15 * M_PI / 180.0;
};

struct TriangulationOptions {
  Fusion fusion = Fusion::Exact;
  int maxIterations = 10;
};

/// A fused pair. With four measurements and three unknowns one degree of freedom is left: the residual.
struct Triangulation {
  Eigen::Vector3d p_h = Eigen::Vector3d::Zero();         ///< in the horizontal sonar's frame
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of p_h [m^2]
  /// Root of the weighted sum of squares of what the point leaves unexplained of the four measurements: for the exact
  /// fusion of a true pair the size of a standard normal variable.
  double residual = 0;
  double elevation_h_rad = 0, elevation_v_rad = 0;  ///< out of either imaging plane
  bool converged = false;                           ///< false: no finite point; nothing else is valid
};

/// Fuses measurements of two sonars with any relative pose and either beam model.
///
/// The exact fusion minimises, over p in the horizontal sonar's frame,
///   sum over both sonars of ((|p_s| - r) / sigma_r)^2 + ((bearing(p_s) - b) / sigma_b)^2
/// by Gauss-Newton from the coordinate-wise point; its covariance is the inverse normal matrix. The other two get their
/// covariance by first-order propagation plus the variance of what they cannot see (the elevation, uniform over the
/// aperture, for `Average`).
class Triangulator {
 public:
  Triangulator(const core::Isometry& T_h_v, obs::BearingModel model_h, obs::BearingModel model_v, double aperture_h_rad,
               double aperture_v_rad, const TriangulationOptions& options = {});

  Triangulation fuse(const BeamMeasurement& h, const BeamMeasurement& v) const;

 private:
  Triangulation fuseExactly(const BeamMeasurement& h, const BeamMeasurement& v) const;
  Eigen::Vector3d fuseByCoordinate(const BeamMeasurement& h, const BeamMeasurement& v) const;
  Eigen::Vector3d startNear(const Eigen::Vector3d& guess) const;
  Triangulation describe(const Eigen::Vector3d& p_h, const BeamMeasurement& h, const BeamMeasurement& v) const;

  core::Isometry T_h_v_, T_v_h_;
  obs::BearingModel model_h_, model_v_;
  double aperture_h_rad_, aperture_v_rad_;
  TriangulationOptions options_;
};

}  // namespace s2s::sonar
