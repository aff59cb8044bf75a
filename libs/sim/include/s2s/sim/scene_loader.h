#pragma once

#include "s2s/core/ini_file.h"
#include "s2s/sim/scene.h"

namespace s2s::sim {

/// Builds the scene that the sections `scene`, `seabed`, `seabed_feature.*`, `material.*`, `object.*`, `vessel_part.*`,
/// `control_point.*` and `experiment.*` of an INI describe; share/docs/simulation.md lists their keys.
/// Mesh files are looked for beside the INI.
/// @throws core::ConfigError naming section and key; core::InputError for a mesh file
Scene loadScene(core::IniFile& ini);

}  // namespace s2s::sim
