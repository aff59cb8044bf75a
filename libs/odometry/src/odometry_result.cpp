#include "s2s/odometry/odometry_result.h"

namespace s2s::odometry {

std::string statusName(OdometryStatus status) {
  switch (status) {
    case OdometryStatus::firstScan:
      return "first scan";
    case OdometryStatus::registered:
      return "registered";
    case OdometryStatus::degenerate:
      return "degenerate";
    case OdometryStatus::deadReckoned:
      return "dead reckoned";
    case OdometryStatus::skipped:
      return "skipped";
  }
  return "unknown";
}

std::string reasonName(OdometryReason reason) {
  switch (reason) {
    case OdometryReason::none:
      return "none";
    case OdometryReason::emptyScan:
      return "no usable point in the scan";
    case OdometryReason::timeNotIncreasing:
      return "the scan ends no later than one before it";
    case OdometryReason::tooFewMatches:
      return "too few points lie on known planes";
    case OdometryReason::weakGeometry:
      return "the surfaces in sight do not hold all directions";
  }
  return "unknown";
}

}  // namespace s2s::odometry
