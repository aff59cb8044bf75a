#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "ouster2rawlog/metadata.h"

namespace s2s::test {

/// The metadata JSON of a small sensor of 4 beams, with sections as firmware 2.4 and later give it.
std::string ousterMetadataJson(const std::string& profile, std::uint32_t columns = 32,
                               std::uint32_t columnsPerPacket = 8);
tools::ouster::Metadata ousterMetadata(const std::string& profile, std::uint32_t columns = 32,
                                       std::uint32_t columnsPerPacket = 8);

/// What a pixel of a test packet holds.
struct OusterPixel {
  std::uint32_t range = 0, range2 = 0;  ///< raw, before any shift
  std::uint32_t reflectivity = 0, reflectivity2 = 0, signal = 0, signal2 = 0, nearInfrared = 0, flags = 0, flags2 = 0;
};

/// A LiDAR packet laid out after the sensor manual's tables, independently of the reader under test. Column c of the
/// packet is number `firstColumn` + c, at the device time `time(number)`.
struct OusterPacketMaker {
  tools::ouster::Metadata metadata;
  std::function<std::uint64_t(std::uint32_t column)> time = [](std::uint32_t column) {
    return 5'000'000'000u + 1000u * column;
  };
  std::function<OusterPixel(std::uint32_t row, std::uint32_t column)> pixel;
  std::function<bool(std::uint32_t column)> valid = [](std::uint32_t) { return true; };

  std::string packet(std::uint32_t frameId, std::uint32_t firstColumn) const;
};

}  // namespace s2s::test
