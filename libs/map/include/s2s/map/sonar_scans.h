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

/// True if a sonar's imaging plane stands upright on the vehicle: its y axis is then nearer to the vehicle's xz plane
/// than to its y axis.
bool isVerticalSonar(const core::Isometry& T_vehicle_sonar);

}  // namespace s2s::map
