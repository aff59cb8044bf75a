#pragma once

#include <cstdint>
#include <vector>

#include "s2s/sim/random.h"
#include "s2s/sim/ray_caster.h"
#include "s2s/sim/sonar_geometry.h"

namespace s2s::sim {

/// Mean echo power (re 1 uPa^2) that arrives from each cell of bearing and range, as a perfectly narrow beam would
/// receive it: before beam pattern, pulse, speckle and noise.
struct EchoImage {
  std::size_t rangeCount = 0, beamCount = 0;
  std::vector<float> power;  ///< row-major, one row a range bin

  void reset(std::size_t ranges, std::size_t beams) {
    rangeCount = ranges;
    beamCount = beams;
    power.assign(ranges * beams, 0.0f);
  }
  float& at(std::size_t bin, std::size_t beam) { return power[bin * beamCount + beam]; }
  float at(std::size_t bin, std::size_t beam) const { return power[bin * beamCount + beam]; }
};

/// A surface patch that answered: where it is and how strong.
struct EchoPatch {
  std::uint32_t beam = 0;
  float range_m = 0;  ///< true slant range
  float power = 0;    ///< its whole echo power, re 1 uPa^2
  std::uint32_t object = 0;
  Eigen::Vector3f p_world = Eigen::Vector3f::Zero();
};

/// Casts rays over each beam's wedge (bearing cell times elevation pattern) and sums the echoes of all surfaces.
///
/// A ray stands for a small solid angle; the patch it meets is taken as plane, and its power is spread evenly over the
/// ranges between which this plane cuts the solid angle, so that a smooth surface fills its range bins without gaps.
class EchoTracer {
 public:
  EchoTracer(const SonarOptions& options, const SonarGeometry& geometry, const Scene& scene, const RayCaster& caster);

  /// @param patches if not null, gets every patch that answered
  void trace(const core::Isometry& T_world_sensor, Random& random, EchoImage& image,
             std::vector<EchoPatch>* patches = nullptr) const;

 private:
  struct Sample;
  void makeRays(const core::Isometry& T_world_sensor, std::size_t beam, Random& random, std::vector<Ray>& rays,
                std::vector<Sample>& samples) const;
  double patchPower(double range_m, double cosIncidence, const Material& material) const;
  void deposit(const Sample& sample, const Ray& ray, const RayHit& hit, double power, EchoImage& image) const;

  const SonarOptions& options_;
  const SonarGeometry& geometry_;
  const Scene& scene_;
  const RayCaster& caster_;
  double elevationMin_rad_, elevationStep_rad_;
};

}  // namespace s2s::sim
