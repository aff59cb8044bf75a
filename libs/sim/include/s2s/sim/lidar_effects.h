#pragma once

#include <Eigen/Core>
#include <vector>

#include "s2s/sim/random.h"
#include "s2s/sim/ray_caster.h"

namespace s2s::sim {

/// What a LiDAR's light does besides flying straight; each effect has its switch.
struct LidarEffects {
  bool noise = true;
  double rangeSigma_m = 0.012;                    ///< on a bright surface at normal incidence
  double rangeSigmaFar_mPerM = 1.0e-4;            ///< grows with range
  double beamDivergence_rad = 0.35 * M_PI / 180;  ///< full width; stretches the echo on inclined surfaces

  bool bias = true;
  double incidenceBias_m = 0.004;  ///< times (1/cos(incidence) - 1), at most ten times this
  double darkBias_m = 0.010;       ///< late detection of a surface of no reflectivity, falling to 0 on a white one

  bool dropouts = true;
  double halfRange_m = 200;  ///< a white surface is lost every other time at this range

  bool mixedPixels = true;
  double mixedMaxGap_m = 1.5;  ///< echoes nearer to each other than this merge into one between them

  bool ownVessel = true;  ///< returns from parts of the vessel

  bool waterReturns = true;
  double waterReturnShare = 0.03;   ///< of beams that meet the surface close by come back from it ...
  double waterReturnRange_m = 8;    ///< ... falling off with range by this e-fold
  double waveHeightSigma_m = 0.03;  ///< scatter of their heights

  bool waterGhosts = true;
  double waterSmoothness = 0.10;  ///< share of the surface's facets that mirror onto the way of the beam
};

/// A candidate echo of one beam: range and brightness (1: a white surface at normal incidence; 0: no echo).
struct LidarEcho {
  double range_m = 0, brightness = 0, cosIncidence = 1;
  bool present() const { return brightness > 0; }
};

/// Brightness of a hit: Lambert's cosine, or far more from retro-reflective foil up to 60 degrees.
LidarEcho echoOf(const RayHit& hit, const Ray& ray, const Material& material);

/// A direction beside a beam's, at a random side of it, that tells whether the beam's footprint lies on an edge. It is
/// so far off that it falls across a straight edge as often as the edge crosses the footprint: an edge x away is met
/// with probability acos(x/angle)/pi, which is angle/pi in all, so the angle is pi times the footprint's radius.
Eigen::Vector3f directionBeside(const Eigen::Vector3f& direction, const LidarEffects& effects, Random& random);

/// A beam's echo and that of the direction beside it: at an edge they merge, and the range comes out between them
/// (Tang, Huber & Akinci 2007, mixed pixels).
void mixPixel(LidarEcho& echo, const LidarEcho& beside, const LidarEffects& effects, Random& random);

/// Echo of a beam that meets the water surface (height 0 in the world): sparse returns from the surface itself.
LidarEcho waterReturn(const Ray& ray, double rangeToWater_m, const LidarEffects& effects, Random& random);

/// The way of a beam after the mirror of the water surface, and the share of its power that goes that way.
struct MirroredRay {
  Ray ray;
  double reflectance = 0;
};
MirroredRay mirrorAtWater(const Ray& ray, double rangeToWater_m, double maxRange_m);

/// Fresnel reflectance of water (n = 1.33) for unpolarised light at a grazing angle with the given sine.
double fresnelReflectance(double sineGrazing);

/// What the device reports of an echo: nothing if it is lost, else a range with noise and bias.
double detectedRange_m(const LidarEcho& echo, const LidarEffects& effects, Random& random);

}  // namespace s2s::sim
