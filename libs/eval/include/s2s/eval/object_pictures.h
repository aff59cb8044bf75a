#pragma once

#include <string>

#include "s2s/eval/object_presence.h"

namespace s2s::eval {

/// Writes `object_NAME.png` into a folder for each object that has kept points, and `objects.jpg` with all of them:
/// from above, and from the side along its longer horizontal axis; on the left the map's points, on the right the true
/// surface, both coloured by height above the bare seabed, with the true outline and a bar for the scale. Of an object
/// longer than 4 m the piece is shown where the map has most stereo points of it, if its triangles are smaller than
/// that.
/// @throws core::OutputError
void writeObjectPictures(const ObjectFinder& finder, const std::string& folder);

}  // namespace s2s::eval
