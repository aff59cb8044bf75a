#pragma once

#include <string>

#include "s2s/sim/survey_simulator.h"

namespace s2s::sim {

/// Writes trajectory.tum (T_world_vehicle, 100 Hz, Unix time), world.ply (triangles with the number of their object),
/// objects.csv, seabed.asc (heights of the bare seabed, ESRI ASCII grid), extrinsics.ini (true
/// mountings and time offsets) and control_points.csv into `folder`.
/// @throws core::OutputError
void writeTruth(const std::string& folder, const Scene& scene, const SimulationOptions& options,
                const VesselMotion& motion, double duration_s);

/// Writes survey.ini: the configuration that a surveyor would have, with labels and nominal mountings.
/// @throws core::OutputError
void writeSurveyIni(const std::string& path, const Scene& scene, const SimulationOptions& options);

}  // namespace s2s::sim
