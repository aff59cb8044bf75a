#include "s2s/obs/register_classes.h"

#include <mrpt/rtti/CObject.h>

#include "s2s/obs/CObservationImagingSonar.h"
#include "s2s/obs/CObservationLidarSweep.h"

namespace s2s::obs {

void registerClasses() {
  mrpt::rtti::registerClass(CLASS_ID(CObservationImagingSonar));
  mrpt::rtti::registerClass(CLASS_ID(CObservationLidarSweep));
}

}  // namespace s2s::obs
