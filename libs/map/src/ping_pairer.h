#pragma once

#include <optional>
#include <vector>

#include "s2s/map/scan.h"
#include "s2s/sonar/sonar_stereo.h"

namespace s2s::map {

/// A ping that was processed, where it was taken from.
struct PlacedPing {
  ScanPose pose;  ///< of the vehicle
  core::Isometry T_map_vehicle = core::Isometry::Identity();
  core::Isometry T_vehicle_sonar = core::Isometry::Identity();
  sonar::ProcessedPing processed;
};

/// Makes stereo points out of pings that come one by one: each ping is paired with the last of the other sonar if that
/// is near enough in time and has no partner yet.
class PingPairer {
 public:
  PingPairer() : stereo_(sonar::horizontalDefaults(), sonar::verticalDefaults()) {}

  const sonar::SonarDevice& device(bool isVertical) const {
    return isVertical ? stereo_.vertical() : stereo_.horizontal();
  }

  struct StereoScan {
    ScanPose pose;  ///< that of the horizontal ping, on the stereo layer
    std::vector<ScanPoint> points;
  };
  /// Takes the next ping; nothing if it finds no partner or the two have no points in common.
  std::optional<StereoScan> add(const PlacedPing& ping, bool isVertical, double window_s);

 private:
  sonar::SonarStereo stereo_;
  std::optional<PlacedPing> lastHorizontal_, lastVertical_;
};

}  // namespace s2s::map
