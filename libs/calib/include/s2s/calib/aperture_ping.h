#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "s2s/core/time.h"
#include "s2s/obs/CObservationImagingSonar.h"

namespace s2s::calib {

/// How both ends of the horizontal sonar's aperture are found on a bed that the vertical sonar knows.
struct ApertureOptions {
  bool enabled = true;
  int pingStep = 2;                              ///< one ping in so many is looked at
  int beamStep = 8, beamsAveraged = 4;           ///< one group of beams in so many beams
  double minRange_m = 1.2;                       ///< nearer bins hold the ring-down
  double stack_s = 10;                           ///< pings of such a time make one profile
  double sector_rad = 10.0 * M_PI / 180;         ///< of bearings, for each of which there is a profile
  double maxBearing_rad = 40.0 * M_PI / 180;     ///< beams further out are not used
  double step_rad = 0.25 * M_PI / 180;           ///< of elevation
  double beyond_rad = 6.0 * M_PI / 180;          ///< profiles reach so far to either side of an end
  double ramp_rad = 2.0 * M_PI / 180;            ///< an end's own width to either side, which tells neither level
  double level_rad = 2.0 * M_PI / 180;           ///< of elevation, from which the levels on both sides are taken
  int minProfiles = 60;                          ///< fewer leave too much speckle
  double minContrast = 2;                        ///< of the level inside over that outside
  double widthSigma_rad = 1.5 * M_PI / 180;      ///< how far both ends may lie beyond the nominal aperture
  double widthBendSigma_rad = 0.5 * M_PI / 180;  ///< and its change from the fan's centre to a radian
  double axisSigma_rad = 0.05 * M_PI / 180;      ///< how far their middle may lie off the imaging plane
};

/// Strength of a ping's echo over range, in groups of beams.
struct AperturePing {
  core::TimeNs time = 0;  ///< as recorded
  double firstRange_m = 0, step_m = 0;
  struct Strip {
    float bearing_rad = 0;
    std::vector<std::uint16_t> strength;  ///< mean square of the samples of each bin
  };
  std::vector<Strip> strips;

  double binRange_m(std::size_t bin) const { return firstRange_m + static_cast<double>(bin) * step_m; }
};

AperturePing aperturePing(const obs::CObservationImagingSonar& ping, core::TimeNs time, const ApertureOptions& options);

}  // namespace s2s::calib
