#pragma once

#include <cstdint>
#include <vector>

#include "s2s/sim/ping_truth.h"
#include "s2s/sim/random.h"
#include "s2s/sim/ray_caster.h"
#include "s2s/sim/sonar_geometry.h"
#include "s2s/sim/surface_multipath.h"

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

/// Casts rays over each beam's wedge (bearing cell times elevation pattern) and sums the echoes of all surfaces.
///
/// A ray stands for a small solid angle; the patch it meets is taken as plane, and its power is spread evenly over the
/// ranges between which this plane cuts the solid angle, so that a smooth surface fills its range bins without gaps.
class EchoTracer {
 public:
  /// All arguments must outlive the tracer.
  EchoTracer(const SonarOptions& options, const SonarGeometry& geometry, const Scene& scene, const RayCaster& caster);

  /// @param strongest if not null, gets the true point behind each beam's strongest return above the noise level
  void trace(const core::Isometry& T_world_sensor, Random& random, EchoImage& image,
             std::vector<StrongReturn>* strongest = nullptr) const;

 private:
  struct Beam;
  void makeRays(const core::Isometry& T_world_sensor, std::size_t beam, Random& random, Beam& work) const;
  double patchPower(double range_m, double cosIncidence, const Material& material,
                    const Eigen::Vector3f& p_world) const;
  void deposit(const Beam& work, std::size_t ray, double power, std::vector<float>& column) const;
  void addGhosts(const core::Isometry& T_world_sensor, const Beam& work, std::size_t ray, double power,
                 EchoImage& image) const;
  void addVolume(EchoImage& image) const;
  void findStrongest(const Beam& work, std::size_t beam, std::vector<StrongReturn>& strongest) const;
  double recordedBin(double range_m) const;

  const SonarOptions& options_;
  const SonarGeometry& geometry_;
  const Scene& scene_;
  const RayCaster& caster_;
  SurfaceMultipath multipath_;
  double noisePower_;
  std::vector<Angle> edgeAngles_;
  std::vector<double> edges_rad_, gains_;  // of the elevation samples; gains are two-way
};

}  // namespace s2s::sim
