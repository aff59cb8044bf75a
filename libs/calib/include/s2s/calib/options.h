#pragma once

#include <cmath>

#include "s2s/calib/aperture_ping.h"
#include "s2s/calib/swath.h"
#include "s2s/calib/texture.h"
#include "s2s/calib/water_mirror.h"

namespace s2s::calib {

/// Everything about the estimation; angles in radians.
struct CalibrationOptions {
  int threads = 1;  ///< of the solver; no key of the INI

  // Data
  int maxEchoes = 120000;         ///< pings are thinned out evenly to stay below this
  double maxBearing_rad = 0.8;    ///< beams further out are not used
  double farEdgeBearing_rad = 0;  ///< far edges further out are not used; 0: none, they lie up to 1.5 deg off

  // Seabed
  double cell_m = 0.25;       ///< of the grid of heights
  double roughness_m = 0.08;  ///< standard deviation of the second difference of neighbouring heights
  int minCellEchoes = 3;      ///< cells with fewer are left out

  // Rounds of association
  int rounds = 10;
  double firstGate_m = 1.0, lastGate_m = 0.25;  ///< echoes further from the seabed are left out; shrinks evenly
  double lossWidth = 2.0;                       ///< of Cauchy's loss, in standard deviations

  /// Share of the ranges' spread that is common to all echoes of a kind (how a device shapes its bands, texture, the
  /// bend of a cell): however many there are, together they tell no more than 1 / share^2 independent ones.
  double commonShare = 0.05;

  /// Error of the sound speed that no echo shows: the scale of the trajectory, against which ranges are held, is not
  /// known better than the LiDAR's ranges are (0.03 %).
  double soundSpeedCommon_mps = 0.45;
  /// The share when time offsets are told: what is common to echoes does not follow the vehicle's turns, waves and
  /// changes of speed, by which they show.
  double timeCommonShare = 0.01;

  ApertureOptions aperture;   ///< section [calibration.aperture]
  TextureOptions texture;     ///< section [calibration.texture]
  WaterMirrorOptions mirror;  ///< section [calibration.mirror]

  // What is known beforehand: how far the truth may be from the nominal values
  double positionSigma_m = 0.1;
  double rotationSigma_rad = 3.0 * M_PI / 180;
  double timeSigma_s = 0.05;
  double soundSpeedSigma_mps = 5;
  double apertureSigma_rad = 1.5 * M_PI / 180;           ///< of the aperture's edges
  double apertureAsymmetrySigma_rad = 0.4 * M_PI / 180;  ///< of the difference of both edges
  double apertureBendSigma_rad = 0.5 * M_PI / 180;       ///< of an edge's change from the fan's centre to a radian
  double rangeSigma_m = 0.01;                            ///< of a constant error of all ranges
  double rangeBearingSigma_m = 0.02;                     ///< of one that grows with bearing, at a radian
  double rangeScaleSigma = 0.004;                        ///< of an error that grows with range

  // Verdict
  double weakShare = 0.5;  ///< a direction known worse than this share of what was known before stays nominal
  // Known better than this is observable, else a rough estimate
  double positionLimit_m = 0.0075;
  double rotationLimit_rad = 0.075 * M_PI / 180;
  double timeLimit_s = 0.0015;
  double soundSpeedLimit_mps = 2;
  double block_s = 5;  ///< errors within such a time are taken as correlated when the covariance is made
};

}  // namespace s2s::calib
