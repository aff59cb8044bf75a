#pragma once

#include "s2s/obs/CObservationImagingSonar.h"

namespace s2s::sonar {

/// Where a beam truly looks that a device steered to `bearing_rad`, when the water's sound speed is `ratio` times the
/// one the device believes: a straight array steers by delays, so sin(true) / c_true = sin(steered) / c_believed.
double trueBearing_rad(double bearing_rad, double ratio);

/// Turns ranges and bearings of a ping into those of the true sound speed, and writes it into the ping.
/// @return false, leaving the ping as it is, if it does not tell the sound speed it was made with
bool correctSoundSpeed(obs::CObservationImagingSonar& ping, double soundSpeed_mps);

}  // namespace s2s::sonar
