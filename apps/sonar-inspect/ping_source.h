#pragma once

#include <string>

#include "s2s/obs/CObservationImagingSonar.h"

namespace s2s::inspect {

struct PingLabels {
  std::string horizontal = "SONAR_HORIZONTAL";
  std::string vertical = "SONAR_VERTICAL";
};

/// The ping to look at and the nearest ping in time of the other sonar.
struct PingPair {
  obs::CObservationImagingSonar::Ptr horizontal;  ///< null if the log has none
  obs::CObservationImagingSonar::Ptr vertical;    ///< null if the log has none
};

/// Reads ping number `index` (from 0) of the horizontal sonar and the vertical ping nearest to it. In a log with one
/// sonar only, the ping of that one, whatever its label.
/// @throws core::InputError if there is no sonar or not that many pings
PingPair readPings(const std::string& rawlog, const PingLabels& labels, std::size_t index);

}  // namespace s2s::inspect
