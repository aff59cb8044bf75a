#pragma once

#include <functional>
#include <vector>

#include "s2s/calib/evidence.h"
#include "s2s/calib/observability.h"
#include "s2s/calib/options.h"
#include "s2s/calib/sonar_parameters.h"

namespace s2s::calib {

/// What a single piece of evidence holds against what.
enum class EvidenceKind : std::uint8_t {
  NearEdge = 0,  ///< first echo of the horizontal sonar on the seabed
  FarEdge = 1,   ///< end of its band there
  Middle = 2,    ///< band of the vertical sonar on the seabed
  WallEdge = 3,  ///< echo of the horizontal sonar on a wall
  WallBand = 4,  ///< band of the vertical sonar on a wall
  Texture = 5,   ///< two pictures of the bed by the horizontal sonar
  Aperture = 6,  ///< ends of the horizontal sonar's aperture on the bed
};
constexpr std::size_t kEvidenceKinds = 7;

/// What was used and how well it fits.
struct CalibrationStatistics {
  std::array<std::size_t, kEvidenceKinds> used{};     ///< in the last round
  std::array<std::size_t, kEvidenceKinds> leftOut{};  ///< beyond the gate or where there is no surface
  std::optional<MirrorDepth> mirror;                  ///< echoes by way of the water surface
  std::array<double, kEvidenceKinds> sigma_m{};       ///< spread of the ranges around the surface; Aperture: [rad]
};

struct CalibrationResult {
  CalibrationState state;
  Observability observability;
  CalibrationStatistics statistics;
};

/// Estimates both sonars' mountings and time offsets and the sound speed from echoes along a known trajectory, together
/// with the heights of the seabed: whatever is wrong makes the same seabed come out at different heights and walls away
/// from where the LiDAR sees them above the water. How deep the sonars are is told by echoes over the water surface.
///
/// @param nominal  known beforehand; where the data tell nothing, this stays
/// @param onRound  called after each round of association with the number done and their total
/// @throws core::InputError if there are too few echoes
CalibrationResult calibrate(const CalibrationState& nominal, const CalibrationEvidence& evidence,
                            const CalibrationOptions& options,
                            const std::function<void(int done, int total)>& onRound = {});

}  // namespace s2s::calib
