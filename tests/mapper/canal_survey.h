#pragma once

#include <mrpt/obs/CObservation.h>

#include <vector>

#include "s2s/core/trajectory.h"
#include "s2s/mapper/survey_config.h"
#include "s2s/sim/survey_simulator.h"

namespace s2s::mapper {

/// Simulated records of a piece of the canal, in order of time, with their truth.
struct CanalSurvey {
  std::vector<mrpt::obs::CObservation::Ptr> records;
  core::Trajectory truth;  ///< T_world_vehicle, every 10 ms

  /// Simulates and keeps the records that `wanted` accepts; may be called again to add those of another receiver.
  void add(const sim::SimulationOptions& options, bool (*wanted)(const mrpt::obs::CObservation&));

  /// Distances of the poses' positions from the truth, after alignment at the first pose.
  std::vector<double> positionErrors_m(const core::Trajectory& T_map_vehicle) const;
};

/// The defaults with the simulated vessel's own parts, as its survey.ini has them.
SurveyConfig canalConfig();

}  // namespace s2s::mapper
