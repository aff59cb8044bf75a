#include "s2s/calib/aperture_ping.h"

#include <algorithm>

namespace s2s::calib {

AperturePing aperturePing(const obs::CObservationImagingSonar& ping, core::TimeNs time,
                          const ApertureOptions& options) {
  AperturePing result;
  result.time = time;
  result.step_m = ping.rangeResolution_m;
  result.firstRange_m = ping.rangeOffset_m + 0.5 * result.step_m;
  const auto step = static_cast<std::size_t>(options.beamStep), count = static_cast<std::size_t>(options.beamsAveraged);
  const double scale = 255.0 / ping.maxSample();
  for (std::size_t first = 0; first + count <= ping.beamCount; first += step) {
    AperturePing::Strip strip;
    double bearing_rad = 0;
    for (std::size_t b = first; b < first + count; ++b)
      bearing_rad += static_cast<double>(ping.bearings_rad[b]) / static_cast<double>(count);
    if (std::abs(bearing_rad) > options.maxBearing_rad) continue;
    strip.bearing_rad = static_cast<float>(bearing_rad);
    strip.strength.reserve(ping.rangeCount);
    for (std::size_t bin = 0; bin < ping.rangeCount; ++bin) {
      double sum = 0;
      for (std::size_t b = first; b < first + count; ++b) sum += std::pow(scale * ping.sample(bin, b), 2);
      strip.strength.push_back(static_cast<std::uint16_t>(std::min(65535.0, sum / static_cast<double>(count))));
    }
    result.strips.push_back(std::move(strip));
  }
  return result;
}

}  // namespace s2s::calib
