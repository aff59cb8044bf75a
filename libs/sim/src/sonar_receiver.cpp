#include "s2s/sim/sonar_receiver.h"

#include <cmath>

namespace s2s::sim {

SonarReceiver::SonarReceiver(const SonarOptions& o) : options_(o) {
  const double resolution_m = o.maxRange_m / o.rangeCount;
  for (int bin = 0; bin < o.rangeCount; ++bin) {
    const double range_m = (bin + 0.5) * resolution_m;
    const double gain_db = o.gain_db + o.tvgSpreading_db * std::log10(range_m) + o.tvgAbsorption_dbPerM * range_m;
    rowGain_.push_back(range_m < o.blanking_m ? 0.0f : static_cast<float>(std::pow(10, 0.05 * gain_db)));
  }
}

void SonarReceiver::quantize(const std::vector<float>& power, std::size_t beamCount,
                             std::vector<std::uint8_t>& samples) const {
  const auto halfGamma = static_cast<float>(0.5 * options_.gamma);
  samples.resize(power.size());
  for (std::size_t bin = 0; bin < rowGain_.size(); ++bin) {
    const float gain2 = rowGain_[bin] * rowGain_[bin];
    for (std::size_t beam = 0; beam < beamCount; ++beam) {
      const float p = std::min(1.0f, power[bin * beamCount + beam] * gain2);
      const float compressed = options_.gamma == 0.5 ? std::sqrt(std::sqrt(p))
                               : options_.gamma == 1 ? std::sqrt(p)
                                                     : std::pow(p, halfGamma);
      samples[bin * beamCount + beam] = static_cast<std::uint8_t>(255.99f * compressed);
    }
  }
}

}  // namespace s2s::sim
