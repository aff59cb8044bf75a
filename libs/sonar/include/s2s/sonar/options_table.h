#pragma once

#include <string>

#include "s2s/core/option_table.h"
#include "s2s/sonar/sonar_stereo.h"

/// The INI keys of every sonar stage. A device's chain stands in the sections [S], [S.preprocess], [S.leading_edge],
/// [S.cfar] and [S.features] with S = `sonar.horizontal` or `sonar.vertical`; the pair's in [sonar.stereo],
/// [sonar.stereo.dbscan], [sonar.stereo.clusters] and [sonar.stereo.matching].
namespace s2s::sonar {

core::OptionTable optionTable(PreprocessOptions& options);
core::OptionTable optionTable(LeadingEdgeOptions& options);
core::OptionTable optionTable(CfarOptions& options);
core::OptionTable optionTable(FeatureOptions& options);
core::OptionTable optionTable(DbscanOptions& options);
core::OptionTable optionTable(ClusterAssociationOptions& options);
core::OptionTable optionTable(FeatureAssociationOptions& options);
/// [sonar.stereo] itself: fusion and gates.
core::OptionTable optionTable(StereoOptions& options);

/// Everything the sonars are configured by.
struct SonarOptions {
  DeviceOptions horizontal = horizontalDefaults();
  DeviceOptions vertical = verticalDefaults();
  StereoOptions stereo;
};

/// Reads one device's sections over `options`. @throws core::ConfigError
void loadDevice(core::IniFile& ini, const std::string& section, DeviceOptions& options);
/// Reads both devices and the pair. @throws core::ConfigError
void loadSonars(core::IniFile& ini, SonarOptions& options);

/// The sections with all current values, ready to be read again.
std::string printDevice(const std::string& section, DeviceOptions options);
std::string printSonars(SonarOptions options);

}  // namespace s2s::sonar
