#pragma once

#include <functional>
#include <vector>

#include "s2s/calib/echo_table.h"
#include "s2s/calib/observability.h"
#include "s2s/calib/options.h"
#include "s2s/calib/sonar_parameters.h"
#include "s2s/core/trajectory.h"

namespace s2s::calib {

/// What was used and how well it fits.
struct CalibrationStatistics {
  std::array<std::size_t, kEchoKinds> echoes{};   ///< used in the last round, by kind
  std::array<std::size_t, kEchoKinds> leftOut{};  ///< beyond the gate or where there is no seabed
  std::array<double, kEchoKinds> rangeSigma_m{};  ///< spread of the ranges around the surface
};

struct CalibrationResult {
  CalibrationState state;
  Observability observability;
  CalibrationStatistics statistics;
};

/// Estimates both sonars' mountings and time offsets and the sound speed from echoes along a known trajectory, together
/// with the heights of the seabed: whatever is wrong makes the same seabed come out at different heights.
///
/// @param nominal      known beforehand; where the data tell nothing, this stays
/// @param T_map_vehicle z up
/// @param onRound      called after each round of association with the number done and their total
/// @throws core::InputError if there are too few echoes
CalibrationResult calibrate(const CalibrationState& nominal, const std::vector<PingEchoes>& pings,
                            const core::Trajectory& T_map_vehicle, const CalibrationOptions& options,
                            const std::function<void(int done, int total)>& onRound = {});

}  // namespace s2s::calib
