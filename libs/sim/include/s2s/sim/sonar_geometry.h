#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "s2s/sim/sonar_options.h"

namespace s2s::sim {

/// Cosine and sine of an angle, for where they are used more than once.
struct Angle {
  explicit Angle(double angle_rad) : cosine(std::cos(angle_rad)), sine(std::sin(angle_rad)) {}
  double cosine, sine;
};

/// Directions of an imaging sonar's beams, in its frame (x along the central beam, y to positive bearings, z up).
class SonarGeometry {
 public:
  explicit SonarGeometry(const SonarOptions& options);

  const std::vector<double>& bearings_rad() const { return bearings_; }
  /// Width of a beam's cell: from half way to its one neighbour to half way to the other.
  double cellWidth_rad(std::size_t beam) const { return edges_[beam + 1] - edges_[beam]; }
  /// Bearing at a fraction in [0, 1) of a beam's cell.
  double bearingInCell_rad(std::size_t beam, double fraction) const {
    return edges_[beam] + fraction * (edges_[beam + 1] - edges_[beam]);
  }
  /// Unit vector at a bearing and an elevation: on the half-plane of constant azimuth, or on the cone that a straight
  /// array forms; in both, the elevation turns out of the imaging plane.
  Eigen::Vector3d direction(const Angle& bearing, const Angle& elevation) const;
  Eigen::Vector3d direction(double bearing_rad, double elevation_rad) const {
    return direction(Angle(bearing_rad), Angle(elevation_rad));
  }
  /// Inverse of `direction`: bearing and elevation of a unit vector.
  Eigen::Vector2d bearingElevation(const Eigen::Vector3d& direction) const;
  /// Where a beam that the device believes at `bearing_rad` really looks, and the reverse: a beam former with a wrong
  /// sound speed turns its beams, sin(true) / c_true = sin(believed) / c_believed.
  double trueBearing_rad(double believed_rad) const;
  double formedBearing_rad(double true_rad) const;
  /// Position on the fan in beams (0: the first beam's centre); out of [-0.5, n - 0.5) means outside the fan.
  double beamPosition(double bearing_rad) const;

 private:
  SonarOptions options_;
  std::vector<double> bearings_, edges_;
};

}  // namespace s2s::sim
