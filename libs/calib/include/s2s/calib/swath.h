#pragma once

#include <cmath>
#include <vector>

#include "s2s/obs/CObservationImagingSonar.h"

namespace s2s::calib {

/// How the band of echoes is found in a ping.
struct SwathOptions {
  int beamStep = 8;                          ///< one beam in so many is looked at
  int beamsAveraged = 3;                     ///< so many neighbours are averaged (odd)
  double minRange_m = 0.8;                   ///< nearer bins hold the ring-down
  double floorQuantile = 0.1;                ///< of a row: the noise floor
  double edgeWindow_rad = 4.0 * M_PI / 180;  ///< of elevation: half the window in which an edge is refined
  double minLength_m = 0.04;                 ///< a shorter band is noise
  double minContrast = 6;                    ///< summed excess over the threshold, in thresholds
};

/// The one band of echoes of a beam: where it begins and ends, half way between noise and echo level.
struct Swath {
  double bearing_rad = 0;
  double near_m = 0, far_m = 0;  ///< ranges of both edges
  double middle_m = 0;           ///< range of the centre of intensity (squared)
  double contrast = 0;           ///< mean excess over the threshold, in thresholds: 1 is the usual echo
};

/// Finds the band of echoes of every `beamStep`-th beam in the raw image.
///
/// Noise floor: a low quantile of every row, then one of every beam. In each beam the band is the run of bins
/// with the largest sum of (sample - threshold), samples clipped so that no glint decides: for two levels with noise of
/// equal size this is the likeliest pair of change points, and it does not depend on which sample first exceeds
/// something. The threshold is half the median echo level. Either edge is then moved to the least-squares step between
/// the levels on its own two sides, in a window of equal elevation at both, so that level and slope of the echo count
/// alike.
std::vector<Swath> findSwaths(const obs::CObservationImagingSonar& ping, const SwathOptions& options);

}  // namespace s2s::calib
