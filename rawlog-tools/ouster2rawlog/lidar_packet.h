#pragma once

#include <cstdint>
#include <string>

#include "ouster2rawlog/lidar_profile.h"
#include "ouster2rawlog/metadata.h"

namespace s2s::tools::ouster {

/// What stands once in a packet. The LEGACY profile has only the frame number, in each column.
struct PacketHeader {
  std::uint32_t type = 0;  ///< 1: LiDAR
  std::uint32_t frameId = 0;
  std::uint32_t initializationId = 0;
  std::uint64_t serialNumber = 0;
};

/// Device times beyond this (the year 2096) are damage.
constexpr std::uint64_t kLatestDeviceTime_ns = 4'000'000'000'000'000'000;

struct ColumnHeader {
  std::uint64_t time_ns = 0;        ///< device clock
  std::uint32_t measurementId = 0;  ///< number of the column in the turn
  bool valid = false;
};

/// Sizes and places in the LiDAR packets of one sensor. Readers take a packet of exactly `packetBytes()` bytes.
class LidarPacketFormat {
 public:
  /// @throws core::InputError if the metadata names a profile that is not known
  explicit LidarPacketFormat(const Metadata& metadata);

  const LidarProfile& profile() const { return *profile_; }
  bool isLegacy() const { return legacy_; }
  std::size_t packetBytes() const;
  std::uint32_t columnsPerPacket() const { return columnsPerPacket_; }
  /// Frame numbers count modulo this.
  std::uint64_t frameIdCount() const { return fusa_ ? std::uint64_t{1} << 32 : std::uint64_t{1} << 16; }

  PacketHeader header(const std::uint8_t* packet) const;
  ColumnHeader column(const std::uint8_t* packet, std::uint32_t column) const;
  const std::uint8_t* pixel(const std::uint8_t* packet, std::uint32_t column, std::uint32_t row) const {
    return columnBegin(packet, column) + columnHeaderBytes_ + row * profile_->pixelBytes;
  }

 private:
  const std::uint8_t* columnBegin(const std::uint8_t* packet, std::uint32_t column) const {
    return packet + packetHeaderBytes_ + column * columnBytes_;
  }

  const LidarProfile* profile_;
  bool legacy_, fusa_;
  std::uint32_t columnsPerPacket_;
  std::size_t packetHeaderBytes_, packetFooterBytes_, columnHeaderBytes_, columnBytes_;
};

}  // namespace s2s::tools::ouster
