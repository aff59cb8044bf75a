#pragma once

#include <mrpt/obs/CObservationGPS.h>

#include <optional>

#include "s2s/core/option_table.h"
#include "s2s/graph/keyframe.h"

namespace s2s::mapper {

/// Standard deviation of a horizontal coordinate at an HDOP of 1, by the kind of fix that the receiver states.
struct GnssReaderOptions {
  double sigmaSingle_m = 2.5;
  double sigmaDifferential_m = 1.0;
  double sigmaFloat_m = 0.4;
  double sigmaFixed_m = 0.03;
  double heightFactor = 2;  ///< a height is so many times worse
};
core::OptionTable optionTable(GnssReaderOptions& options);

/// WGS84.
struct GeodeticPosition {
  double latitude_deg = 0, longitude_deg = 0, height_m = 0;
};

/// Turns GGA messages into positions in the local east-north-up frame of the first fix.
class GnssReader {
 public:
  explicit GnssReader(const GnssReaderOptions& options) : options_(options) {}

  /// A fix without the odometry's pose; nothing if the record holds no GGA message or no valid position. Heights are
  /// those above mean sea level as the receiver states them.
  std::optional<graph::GnssFix> read(const mrpt::obs::CObservationGPS& observation);

  /// Origin of the east-north-up frame, once there was a fix.
  const std::optional<GeodeticPosition>& origin() const { return origin_; }

 private:
  GnssReaderOptions options_;
  std::optional<GeodeticPosition> origin_;
};

/// The geodetic position of a point given in the east-north-up frame of `origin`.
GeodeticPosition toGeodetic(const Eigen::Vector3d& p_enu, const GeodeticPosition& origin);

}  // namespace s2s::mapper
