#include "s2s/map/register_classes.h"

#include <mrpt/rtti/CObject.h>

#include "s2s/map/CSeabedSkyMap.h"

namespace s2s::map {

void registerClasses() { mrpt::rtti::registerClass(CLASS_ID(CSeabedSkyMap)); }

}  // namespace s2s::map
