#include "s2s/sonar/arc_intersection.h"

#include <algorithm>
#include <cmath>

namespace s2s::sonar {

FeatureArc arcOf(double range_m, double bearing_rad, obs::BearingModel model) {
  const double c = range_m * std::cos(bearing_rad), s = range_m * std::sin(bearing_rad);
  if (model == obs::BearingModel::Azimuth) return {{0, 0, 0}, {c, s, 0}, {0, 0, range_m}, range_m};
  return {{0, s, 0}, {c, 0, 0}, {0, 0, c}, range_m};
}

BeamPlane planeOf(double range_m, double bearing_rad, obs::BearingModel model, const core::Isometry& T_v_h) {
  // In the vertical sonar's frame: azimuth -sin(b) x + cos(b) y = 0; cone y = r sin(b).
  const Eigen::Vector3d normal_v = model == obs::BearingModel::Azimuth
                                       ? Eigen::Vector3d(-std::sin(bearing_rad), std::cos(bearing_rad), 0)
                                       : Eigen::Vector3d(0, 1, 0);
  const double offset_v = model == obs::BearingModel::Azimuth ? 0 : range_m * std::sin(bearing_rad);
  return {T_v_h.linear().transpose() * normal_v, offset_v - normal_v.dot(T_v_h.translation()), range_m};
}

ArcIntersector::ArcIntersector(const core::Isometry& T_h_v, double aperture_h_rad, double aperture_v_rad,
                               double margin_rad)
    : origin_v_h_(T_h_v.translation()),
      normal_v_h_(T_h_v.linear().col(2)),
      sinHalfAperture_h_(std::sin(0.5 * aperture_h_rad + margin_rad)),
      sinHalfAperture_v_(std::sin(0.5 * aperture_v_rad + margin_rad)) {}

std::optional<ArcPlanePoint> ArcIntersector::intersect(const FeatureArc& arc, const BeamPlane& plane) const {
  // alpha cos(psi) + beta sin(psi) = gamma
  const double alpha = plane.normal.dot(arc.a), beta = plane.normal.dot(arc.b);
  const double gamma = plane.offset - plane.normal.dot(arc.center);
  const double squared = alpha * alpha + beta * beta;
  const double inside = squared - gamma * gamma;
  if (inside < 0 || squared < 1e-9 * arc.range_m * arc.range_m) return std::nullopt;
  const double root = std::sqrt(inside);
  // Of the two points the one further in front, that is with the larger cos(psi).
  const double sign = beta >= 0 ? 1.0 : -1.0;
  const double cosPsi = (alpha * gamma + sign * beta * root) / squared;
  const double sinPsi = (beta * gamma - sign * alpha * root) / squared;
  if (cosPsi <= 0) return std::nullopt;

  ArcPlanePoint point;
  point.p_h = arc.center + arc.a * cosPsi + arc.b * sinPsi;
  if (std::abs(point.p_h.z()) > arc.range_m * sinHalfAperture_h_) return std::nullopt;
  const Eigen::Vector3d d = point.p_h - origin_v_h_;
  const double range_v = d.norm();
  if (std::abs(normal_v_h_.dot(d)) > range_v * sinHalfAperture_v_) return std::nullopt;
  point.rangeMisfit_m = range_v - plane.range_m;
  return point;
}

std::pair<double, double> ArcIntersector::rangesFromVertical(const FeatureArc& arc) const {
  // Along the arc the range is smooth and the arc short: the ends and the middle bound it to a fraction of a bin.
  const double sinEnd = std::min(1.0, sinHalfAperture_h_ * arc.range_m / std::max(1e-9, arc.b.norm()));
  const double cosEnd = std::sqrt(1 - sinEnd * sinEnd);
  double low = (arc.center + arc.a - origin_v_h_).norm(), high = low;
  for (const double sign : {-1.0, 1.0}) {
    const double range = (arc.center + arc.a * cosEnd + sign * arc.b * sinEnd - origin_v_h_).norm();
    low = std::min(low, range);
    high = std::max(high, range);
  }
  return {low, high};
}

}  // namespace s2s::sonar
