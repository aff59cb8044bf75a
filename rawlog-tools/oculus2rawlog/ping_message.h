#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace s2s::tools::oculus {

/// The 16 bytes before every message of an Oculus sonar (little-endian, packed).
struct MessageHeader {
  static constexpr std::size_t kBytes = 16;
  std::uint16_t source = 0, destination = 0;
  std::uint16_t type = 0;     ///< 0x23: simple ping result
  std::uint16_t version = 0;  ///< 2: ping results of the second layout
  std::uint32_t payloadBytes = 0;
  std::size_t messageBytes() const { return kBytes + payloadBytes; }
};

constexpr std::uint16_t kSimplePingResult = 0x23;

/// The header at the beginning of `bytes`; nothing if they are too few or do not look like one (sync word, a known
/// type, a size that a message can have).
std::optional<MessageHeader> parseHeader(std::string_view bytes);

/// A ping as the sonar sends it.
struct Ping {
  std::uint32_t pingId = 0;
  double frequency_hz = 0;
  double soundSpeed_mps = 0;  ///< as used by the device
  double gain_percent = 0;
  std::uint32_t startTime_ns = 0;     ///< first layout: a counter of nanoseconds that wraps every 4.29 s
  std::optional<double> startTime_s;  ///< second layout: seconds since power-up
  std::uint8_t bytesPerSample = 1;
  double rangeResolution_m = 0;
  std::uint16_t rangeCount = 0, beamCount = 0;
  std::vector<std::int16_t> bearings_cdeg;  ///< 0.01 degrees, growing to starboard
  std::vector<std::uint8_t> samples;        ///< range-major, without the gains
  std::vector<std::uint32_t> rowGains;      ///< empty, or one a range
};

/// A ping, or why the bytes are none.
struct PingResult {
  std::optional<Ping> ping;
  std::string fault;
};

/// Reads a whole simple ping result, header included. Whether rows begin with a gain is seen from the image's size, not
/// from the flags, which are known to differ.
PingResult parsePing(std::string_view message);

}  // namespace s2s::tools::oculus
