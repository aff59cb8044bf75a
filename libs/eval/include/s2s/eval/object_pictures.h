#pragma once

#include <string>

#include "s2s/eval/object_presence.h"

namespace s2s::eval {

/// Writes `object_NAME.png` into a folder for each object that has kept points: from above, and from the side along its
/// longer horizontal axis. The true surface is drawn in grey lines, the map's points by layer: stereo white, horizontal
/// line-scan green, vertical line-scan orange.
/// @throws core::OutputError
void writeObjectPictures(const ObjectFinder& finder, const std::string& folder);

}  // namespace s2s::eval
