#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>

#include "s2s/core/transform.h"
#include "s2s/sonar/ping_geometry.h"

namespace s2s::sonar {

/// The possible points of a feature of the horizontal sonar, in its frame: center + a cos(psi) + b sin(psi). Holds for
/// both beam models: constant azimuth has center 0 and psi = elevation; the cone has its circle around the y axis.
struct FeatureArc {
  Eigen::Vector3d center, a, b;
  double range_m = 0;
};

/// What a feature of the vertical sonar demands of a point p in the horizontal sonar's frame: normal . p = offset (its
/// beam's plane; under the cone model the plane that cuts the cone at the measured range).
struct BeamPlane {
  Eigen::Vector3d normal;
  double offset = 0;
  double range_m = 0;
};

FeatureArc arcOf(double range_m, double bearing_rad, obs::BearingModel model);
BeamPlane planeOf(double range_m, double bearing_rad, obs::BearingModel model, const core::Isometry& T_v_h);

/// Where an arc meets a beam plane.
struct ArcPlanePoint {
  Eigen::Vector3d p_h;
  double rangeMisfit_m = 0;  ///< range of that point from the vertical sonar less the range it measured
};

/// The closed-form companion of the exact triangulation: meets three of the four measurements exactly, and the misfit
/// of the fourth, divided by its standard deviation, is the residual of the least squares to first order. This is the
/// geometric matching cost, at a hundredth of the price.
class ArcIntersector {
 public:
  ArcIntersector(const core::Isometry& T_h_v, double aperture_h_rad, double aperture_v_rad, double margin_rad);

  /// Nothing if they do not meet in front of the horizontal sonar or outside one of the apertures (plus margin).
  std::optional<ArcPlanePoint> intersect(const FeatureArc& arc, const BeamPlane& plane) const;

  /// Smallest and largest range from the vertical sonar of the arc's points within the aperture.
  std::pair<double, double> rangesFromVertical(const FeatureArc& arc) const;

 private:
  Eigen::Vector3d origin_v_h_;  // the vertical sonar's origin in the horizontal sonar's frame
  Eigen::Vector3d normal_v_h_;  // the normal of its imaging plane
  double sinHalfAperture_h_, sinHalfAperture_v_;
};

}  // namespace s2s::sonar
