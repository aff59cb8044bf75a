#pragma once

#include <string>

#include "temp_folder.h"

namespace s2s::test {

inline std::string pluginPath() { return std::string(S2S_LIB_DIR) + "/libseabed-sky-plugin.so"; }

inline std::string dataFile(const std::string& name) { return std::string(S2S_SOURCE_DIR) + "/tests/data/" + name; }

/// A rawlog with one record of each of our observations: observation-only rawlogs may simply be joined.
inline void writeSurvey(const std::string& path) {
  writeBytes(path, readBytes(dataFile("obs_version_0/imaging_sonar.rawlog")) +
                       readBytes(dataFile("obs_version_0/lidar_sweep.rawlog")));
}

}  // namespace s2s::test
