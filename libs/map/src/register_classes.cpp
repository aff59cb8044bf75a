#include "s2s/map/register_classes.h"

#include <mrpt/rtti/CObject.h>

#include "s2s/map/CSeabedSkyMap.h"

// The list of names must hold the fully qualified class name, or MRPT cannot create the map. The macro stands here
// because a linker takes this file only when `registerClasses` is called.
MAP_DEFINITION_REGISTER("s2s::map::CSeabedSkyMap,seabedSkyMap", s2s::map::CSeabedSkyMap)

namespace s2s::map {

void registerClasses() { mrpt::rtti::registerClass(CLASS_ID(CSeabedSkyMap)); }

}  // namespace s2s::map
