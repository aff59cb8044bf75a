#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace s2s::tools::ouster {

/// Where a number stands in the bytes of a pixel: `bits` from `firstBit` on (little-endian), then shifted up by
/// `shift`.
struct PixelField {
  unsigned firstBit = 0;
  unsigned bits = 0;  ///< 0: the profile has no such field
  unsigned shift = 0;
  bool exists() const { return bits != 0; }

  std::uint32_t read(const std::uint8_t* pixel) const {
    std::uint64_t word = 0;
    std::memcpy(&word, pixel + firstBit / 8, (firstBit % 8 + bits + 7) / 8);
    return static_cast<std::uint32_t>((word >> (firstBit % 8)) & ((std::uint64_t{1} << bits) - 1)) << shift;
  }
};

/// How a UDP profile lays out a pixel. Ranges are in millimetres after the shift, near-infrared in photons likewise.
struct LidarProfile {
  struct Echo {
    PixelField range, reflectivity, signal, flags;
  };
  std::string name;
  std::size_t pixelBytes = 0;
  std::vector<Echo> echoes;  ///< strongest first
  PixelField nearInfrared;
  std::string notKept;  ///< fields that an observation has no place for; empty if none
};

/// The profile of that name; null if it is unknown.
const LidarProfile* findLidarProfile(const std::string& name);
/// All known names, for messages.
std::vector<std::string> lidarProfileNames();

}  // namespace s2s::tools::ouster
