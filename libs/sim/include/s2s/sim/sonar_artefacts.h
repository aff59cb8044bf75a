#pragma once

#include <cstdint>
#include <vector>

#include "s2s/sim/random.h"
#include "s2s/sim/sonar_geometry.h"

namespace s2s::sim {

/// What electronics and the neighbouring sonar add to a ping, on the powers after beam forming (re 1 uPa^2).
///
/// `power` is range-major with `options.beamCount` columns. Each effect changes it in place and has its switch in
/// `SonarArtefacts`; levels are given against the receiver's noise level, so that they follow the device.
class ArtefactModel {
 public:
  ArtefactModel(const SonarOptions& options, const SonarGeometry& geometry, std::uint64_t deviceSeed);

  /// @param t_s time of the ping, from which the other sonar's transmissions are found
  void apply(std::vector<float>& power, double t_s, Random& random) const;

 private:
  void leakRows(std::vector<float>& power, Random& random) const;
  void addRingDown(std::vector<float>& power, Random& random) const;
  void addCentreHaze(std::vector<float>& power, Random& random) const;
  void addStreaks(std::vector<float>& power, Random& random) const;
  void addCrossTalk(std::vector<float>& power, double t_s, Random& random) const;
  void bandRows(std::vector<float>& power, Random& random) const;

  SonarOptions options_;
  std::size_t beams_, ranges_;
  double resolution_m_, noisePower_;
  std::vector<float> haze_;         // shape of the centre-beam haze, per beam
  std::vector<double> bandOffset_;  // the device's own gain error of each group of rows, dB
};

}  // namespace s2s::sim
