#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "s2s/core/time.h"
#include "s2s/obs/CObservationImagingSonar.h"

namespace s2s::calib {

/// How the bed's texture in the horizontal sonar's pings is used.
struct TextureOptions {
  bool enabled = true;
  double minRange_m = 1.2;                        ///< nearer bins hold the ring-down
  double bandLevel = 0.4;                         ///< of a beam's strongest echo, averaged: where its band ends
  double meanReach_m = 0.3;                       ///< a sample is held against the mean of so much range either way ...
  double meanReach_rad = 3.0 * M_PI / 180;        ///< ... and so much bearing
  double apertureShare = 0.75;                    ///< of half the aperture: elevations further out are not used
  double group_s = 0.5;                           ///< pings of such a time are averaged into one picture of the bed
  double pixel_m = 0.04;                          ///< of these pictures
  double tile_m = 1.6;                            ///< side of the squares that are found again
  double fineBlur_m = 0.03, coarseBlur_m = 0.15;  ///< pictures are their difference between these two
  double minOverlap = 0.4;                        ///< of a tile that both pictures must show
  int pairsPerTile = 24;
  double minGap_s = 1.0;                         ///< between two pictures of a pair
  double minCorrelation = 0.35;                  ///< at the peak
  double minDistinctness = 1.3;                  ///< peak over the next best one
  double tiltSigma_mPerRad = 0.05;               ///< of how much higher the bed seems, growing with elevation
  double firstReach_m = 0.6, lastReach_m = 0.2;  ///< displacements up to this are looked for; shrinks with the rounds
};

/// The contrast of a ping's echo of the bed: each sample against the mean of its neighbourhood, so that neither range
/// nor beam pattern nor gain is left in it. Beams are paired, and bins.
struct TexturePing {
  core::TimeNs time = 0;  ///< as recorded
  double firstRange_m = 0, step_m = 0;
  struct Beam {
    float bearing_rad = 0;
    std::uint16_t firstBin = 0;         ///< where its band of echo begins
    std::vector<std::int8_t> contrast;  ///< relative excess over the mean, times kContrastScale
  };
  std::vector<Beam> beams;

  double binRange_m(std::size_t bin) const { return firstRange_m + static_cast<double>(bin) * step_m; }
};
constexpr float kContrastScale = 60;

TexturePing texturePing(const obs::CObservationImagingSonar& ping, core::TimeNs time, const TextureOptions& options);

}  // namespace s2s::calib
