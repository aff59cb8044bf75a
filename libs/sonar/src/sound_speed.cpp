#include "s2s/sonar/sound_speed.h"

#include <algorithm>
#include <cmath>

namespace s2s::sonar {

double trueBearing_rad(double bearing_rad, double ratio) {
  return std::asin(std::clamp(ratio * std::sin(bearing_rad), -1.0, 1.0));
}

bool correctSoundSpeed(obs::CObservationImagingSonar& ping, double soundSpeed_mps) {
  if (ping.soundSpeed_mps <= 0) return false;
  const double ratio = soundSpeed_mps / ping.soundSpeed_mps;
  ping.rangeOffset_m *= ratio;
  ping.rangeResolution_m *= ratio;
  for (float& bearing : ping.bearings_rad) bearing = static_cast<float>(trueBearing_rad(bearing, ratio));
  ping.soundSpeed_mps = soundSpeed_mps;
  return true;
}

}  // namespace s2s::sonar
