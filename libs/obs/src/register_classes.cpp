#include "s2s/obs/register_classes.h"

#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/rtti/CObject.h>

#include "s2s/obs/CObservationImagingSonar.h"
#include "s2s/obs/CObservationLidarSweep.h"

namespace s2s::obs {

void registerClasses() {
  mrpt::rtti::registerClass(CLASS_ID(CObservationImagingSonar));
  mrpt::rtti::registerClass(CLASS_ID(CObservationLidarSweep));
  // Point clouds and their maps register themselves when mrpt-maps is loaded; naming one keeps that library linked.
  mrpt::rtti::registerClass(CLASS_ID(mrpt::obs::CObservationPointCloud));
}

}  // namespace s2s::obs
