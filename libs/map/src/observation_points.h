#pragma once

#include <mrpt/obs/CObservation.h>

#include <optional>
#include <vector>

#include "s2s/map/options.h"
#include "s2s/map/scan.h"

namespace s2s::map {

/// True if `pointsOf` can give points for this class of observation.
bool carriesPoints(const mrpt::obs::CObservation& observation);

/// The points of a LiDAR sweep, a point cloud, or any other observation that MRPT's point maps take, in the vehicle's
/// frame and as measured (not deskewed). Nothing if the observation has none.
std::optional<std::vector<ScanPoint>> pointsOf(const mrpt::obs::CObservation& observation,
                                               const InsertionOptions& options);

}  // namespace s2s::map
