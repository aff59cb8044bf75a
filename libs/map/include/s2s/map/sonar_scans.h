#pragma once

#include <vector>

#include "s2s/core/transform.h"
#include "s2s/map/scan.h"
#include "s2s/sonar/leading_edge.h"
#include "s2s/sonar/sonar_stereo.h"

namespace s2s::map {

/// The leading edge of a ping as the map takes it, returns behind the first of a beam included.
LineScan toMapLineScan(const sonar::LineScan& leadingEdge, const core::Isometry& T_vehicle_sonar);

/// Stereo points as the map takes them, in the vehicle's frame at the time of the horizontal sonar's ping.
std::vector<ScanPoint> toScanPoints(const std::vector<sonar::StereoPoint>& points,
                                    const core::Isometry& T_vehicle_horizontal);

/// True if a sonar's imaging plane stands upright, whatever way the sonar looks: it is rolled by more than 45 degrees
/// about its central beam. Of one that looks straight down (or up), where there is no roll: true if its fan lies along
/// the vehicle rather than across it.
bool isVerticalSonar(const core::Isometry& T_vehicle_sonar);

}  // namespace s2s::map
