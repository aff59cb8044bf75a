// What happens when a program loads libseabed-sky-plugin.so: our classes become known to MRPT.

#include <mrpt/core/initializer.h>

#include "s2s/map/register_classes.h"
#include "s2s/obs/register_classes.h"

MRPT_INITIALIZER(registerSeabedSkyClasses) {
  s2s::obs::registerClasses();
  s2s::map::registerClasses();
}
