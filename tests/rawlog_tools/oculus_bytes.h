#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "byte_writer.h"

namespace s2s::test {

/// The settings of a test ping.
struct OculusPing {
  int layout = 1;
  int bytesPerSample = 1;
  bool gain = false;
  std::uint32_t pingId = 7;
  double startTime = 0;  ///< nanoseconds in layout 1, seconds in layout 2
  std::uint16_t ranges = 5, beams = 4;
  std::vector<std::int16_t> bearings = {-6000, -1000, 1500, 6000};
};

/// Sample of a test ping; fills the given number of bytes.
inline std::uint32_t oculusSample(const OculusPing& ping, std::uint32_t range, std::uint32_t beam) {
  const std::uint32_t value = 0x91827364u + 0x01010101u * (range * 8 + beam);
  return ping.bytesPerSample == 4 ? value : value & ((1u << (8 * ping.bytesPerSample)) - 1);
}
inline std::uint32_t oculusGain(std::uint32_t range) { return 1'000'000 + range; }

inline std::string oculusHeader(std::uint16_t type, std::uint16_t version, std::uint32_t payload) {
  ByteWriter out;
  out.add(std::uint16_t{0x4f53}).add(std::uint16_t{7892}).add(std::uint16_t{0}).add(type).add(version).add(payload);
  return out.add(std::uint16_t{0}).bytes();
}

/// A simple ping result as the sonar would send it, with a gap between bearings and image as real ones have.
inline std::string oculusMessage(const OculusPing& ping) {
  ByteWriter image;
  for (std::uint32_t range = 0; range < ping.ranges; ++range) {
    if (ping.gain) image.add(oculusGain(range));
    for (std::uint32_t beam = 0; beam < ping.beams; ++beam) {
      const std::uint32_t value = oculusSample(ping, range, beam);
      image.add(std::string(reinterpret_cast<const char*>(&value), static_cast<std::size_t>(ping.bytesPerSample)));
    }
  }
  const auto imageSize = static_cast<std::uint32_t>(image.bytes().size());
  const std::uint32_t headBytes = ping.layout == 2 ? 202 : 122, imageOffset = headBytes + 2u * ping.beams + 30;
  const std::uint32_t messageSize = imageOffset + imageSize;

  ByteWriter out;
  out.add(oculusHeader(0x23, ping.layout == 2 ? 2 : 0, messageSize - 16));
  out.zeros(5).add(8.0).add(55.0).add(0.0).add(35.0);           // modes; range, gain, sound speed, salinity settings
  if (ping.layout == 2) out.zeros(89 - out.bytes().size());     // extended flags and reserved words
  out.add(ping.pingId).add(0u).add(750e3).add(11.5).add(1.25);  // status, frequency, temperature, pressure
  if (ping.layout == 2) out.add(10.0).add(20.0).add(30.0);      // heading, pitch, roll
  out.add(1475.25);                                             // sound speed used
  if (ping.layout == 2)
    out.add(ping.startTime);
  else
    out.add(static_cast<std::uint32_t>(ping.startTime));
  out.add(static_cast<std::uint8_t>(ping.bytesPerSample - 1)).add(0.0125).add(ping.ranges).add(ping.beams);
  if (ping.layout == 2) out.zeros(16);
  out.add(imageOffset).add(imageSize).add(messageSize);
  for (const std::int16_t bearing : ping.bearings) out.add(bearing);
  return out.zeros(30).add(image.bytes()).bytes();
}

}  // namespace s2s::test
