#pragma once

#include <mrpt/obs/CObservationIMU.h>

#include "s2s/core/time.h"
#include "s2s/obs/CObservationImagingSonar.h"
#include "s2s/obs/CObservationLidarSweep.h"

namespace s2s::test {

/// 2024-12-05T12:00:00.1234567Z, a time that needs all digits of a tick.
constexpr core::TimeNs kSampleTime = 1'733'400'000'123'456'700;

/// Small observations in which every field has a value of its own, other than its default. What the byte images in
/// tests/data hold must not change with them: a new field of a class gets its value in these functions, and the
/// images of older versions stay.
obs::CObservationImagingSonar::Ptr samplePing();
obs::CObservationLidarSweep::Ptr sampleSweep();
mrpt::obs::CObservationIMU::Ptr sampleImu(core::TimeNs time);

}  // namespace s2s::test
