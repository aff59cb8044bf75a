#pragma once

#include "s2s/core/ini_file.h"
#include "s2s/core/option_table.h"
#include "s2s/sim/survey_simulator.h"

namespace s2s::sim {

/// The INI keys of each options struct. A table refers to its struct and must not outlive it.
core::OptionTable optionTable(VesselOptions& options);
core::OptionTable optionTable(WaveOptions& options);
core::OptionTable optionTable(LidarOptions& options);
core::OptionTable optionTable(ImuOptions& options);
core::OptionTable optionTable(SonarOptions& options);
core::OptionTable optionTable(GnssOptions& options);
core::OptionTable optionTable(MountingErrors& errors);
core::OptionTable optionTable(SensorFaults& faults);
/// The faults that are not one sensor's own.
core::OptionTable optionTable(FaultOptions& faults);

/// Reads the sections `vessel`, `waves`, `lidar`, `imu`, `sonar.horizontal`, `sonar.vertical`, `gnss`, `mounting`,
/// `faults` and `faults.<sensor>`.
/// @throws core::ConfigError
void loadSimulationOptions(core::IniFile& ini, SimulationOptions& options);

/// All sections with their current values and help, as `--list-options` and the effective configuration show them.
std::string printSimulationOptions(SimulationOptions options);

}  // namespace s2s::sim
