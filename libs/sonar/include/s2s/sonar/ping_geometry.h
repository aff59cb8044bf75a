#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "s2s/obs/CObservationImagingSonar.h"

namespace s2s::sonar {

/// Where the pixels of a ping lie: everything of an imaging-sonar observation but its samples.
///
/// Frame: x along the central beam, imaging plane xy, bearings positive toward +y (see CObservationImagingSonar).
struct PingGeometry {
  std::vector<double> bearings_rad;  ///< one a beam, strictly monotonic
  double rangeOffset_m = 0;          ///< near edge of the first range bin
  double rangeResolution_m = 0;      ///< length of a range bin
  std::size_t rangeCount = 0;
  double verticalAperture_rad = 0;  ///< full opening angle across the imaging plane
  obs::BearingModel bearingModel = obs::BearingModel::Azimuth;

  std::size_t beamCount() const { return bearings_rad.size(); }
  /// Range of the centre of a bin.
  double range_m(double bin) const { return rangeOffset_m + (bin + 0.5) * rangeResolution_m; }
  double maxRange_m() const { return rangeOffset_m + static_cast<double>(rangeCount) * rangeResolution_m; }
  /// Fractional bin whose centre is at a range; may be outside the image.
  double binAt(double range_m) const { return (range_m - rangeOffset_m) / rangeResolution_m - 0.5; }
  /// Fractional beam of a bearing by linear interpolation between beams; -1 if outside the fan.
  double beamAt(double bearing_rad) const;
  /// Smallest and largest bearing.
  double minBearing_rad() const;
  double maxBearing_rad() const;
};

PingGeometry geometryOf(const obs::CObservationImagingSonar& ping);

/// What a sonar measures of a point, and the elevation out of its imaging plane that it does not measure.
struct SonarCoordinates {
  double range_m = 0;
  double bearing_rad = 0;
  double elevation_rad = 0;  ///< asin(z / |p|), positive toward +z of the sonar
};

SonarCoordinates sonarCoordinates(const Eigen::Vector3d& p_sonar, obs::BearingModel model);

/// The point in front of the sonar with these coordinates. Under the cone model bearing and elevation together cannot
/// exceed 90 degrees; an elevation beyond that is taken as the largest possible one.
Eigen::Vector3d pointAt(const SonarCoordinates& coordinates, obs::BearingModel model);

}  // namespace s2s::sonar
