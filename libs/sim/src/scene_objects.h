#pragma once

#include <cstdint>
#include <string>

#include "s2s/core/ini_file.h"
#include "s2s/sim/scene.h"

namespace s2s::sim {

/// Makes the object of a section `object.NAME`; its `shape` decides which keys the section may have.
/// @throws core::ConfigError for an unknown shape, material or key
SceneObject loadObject(core::IniFile& ini, const std::string& section, const Scene& scene, std::uint64_t seed);

}  // namespace s2s::sim
