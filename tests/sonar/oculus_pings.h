#pragma once

#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "s2s/obs/CObservationImagingSonar.h"

namespace s2s::sonar::test {

/// The pings of a recorded Oculus byte stream: messages of type 0x23 in the first layout, 8 bit, without gain. Just
/// enough for the recording used here; the converter `oculus2rawlog` reads all variants.
inline std::vector<obs::CObservationImagingSonar> readOculusPings(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  const auto at = [&bytes](std::size_t offset, auto value) {
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
  };
  std::vector<obs::CObservationImagingSonar> pings;
  for (std::size_t begin = 0; begin + 122 <= bytes.size();) {
    const std::size_t size = 16 + at(begin + 10, std::uint32_t{});
    obs::CObservationImagingSonar ping;
    ping.sensorLabel = "OCULUS";
    ping.rangeResolution_m = at(begin + 98, double{});
    ping.rangeCount = at(begin + 106, std::uint16_t{});
    ping.beamCount = at(begin + 108, std::uint16_t{});
    const std::size_t image = begin + at(begin + 110, std::uint32_t{});
    ping.samples.assign(bytes.begin() + static_cast<std::ptrdiff_t>(image),
                        bytes.begin() + static_cast<std::ptrdiff_t>(image) +
                            static_cast<std::ptrdiff_t>(ping.rangeCount) * static_cast<std::ptrdiff_t>(ping.beamCount));
    for (std::size_t i = 0; i < ping.beamCount; ++i)
      ping.bearings_rad.push_back(static_cast<float>(-0.01 * M_PI / 180 * at(begin + 122 + 2 * i, std::int16_t{})));
    ping.verticalAperture_rad = 20 * M_PI / 180;
    pings.push_back(ping);
    begin += size;
  }
  return pings;
}

}  // namespace s2s::sonar::test
