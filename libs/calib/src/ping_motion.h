#pragma once

#include <optional>

#include "s2s/calib/surface_residual.h"
#include "s2s/core/trajectory.h"

namespace s2s::calib {

/// Where the vehicle was at a ping and how it moved. Nothing outside the trajectory, in its gaps, and where it moves as
/// no vessel does. `recorded` is freed of the sonar's present time offset.
std::optional<PingMotion> pingMotionAt(const core::Trajectory& T_map_vehicle, core::TimeNs recorded,
                                       const SonarState& sonar);

}  // namespace s2s::calib
