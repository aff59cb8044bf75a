#pragma once

#include <cstdint>
#include <vector>

#include "s2s/sim/random.h"
#include "s2s/sim/sonar_echo.h"
#include "s2s/sim/sonar_geometry.h"

namespace s2s::sim {

/// Makes what beam former and matched filter give out of the echo powers: a field of random complex scatterers (which
/// is what makes speckle, Goodman 2007) is seen through the beam pattern and the pulse, looks are averaged.
class BeamFormer {
 public:
  BeamFormer(const SonarOptions& options, const SonarGeometry& geometry);

  /// Power of each pixel, range-major. Without speckle the powers themselves are blurred.
  void form(const EchoImage& echo, std::uint64_t noiseKey, std::vector<float>& power) const;

  /// Sum over a uniform field of scatterers of the squared response of a beam: what a uniform field is multiplied by.
  double responseEnergy(std::size_t beam) const { return energy_[beam]; }

 private:
  void blurBearing(const float* row, float* out, bool squared) const;
  void blurRange(std::vector<float>& image, bool squared) const;

  SonarOptions options_;
  std::size_t beams_, ranges_, reach_ = 0;
  std::vector<float> weights_;  // (2 reach + 1) rows of one weight a beam
  std::vector<float> squared_;
  std::vector<float> pulse_;  // odd length
  std::vector<double> energy_;
};

/// Power to samples: time-varying gain, blanking, compression, saturation, quantisation to 8 bits.
class SonarReceiver {
 public:
  explicit SonarReceiver(const SonarOptions& options);
  void quantize(const std::vector<float>& power, std::size_t beamCount, std::vector<std::uint8_t>& samples) const;

 private:
  SonarOptions options_;
  std::vector<float> rowGain_;  // amplitude gain of each range bin
};

/// Two independent standard normals for each index, from a counter: fills `re` and `im`.
void fillComplexNormals(std::uint64_t key, std::size_t count, float* re, float* im);

}  // namespace s2s::sim
