#include "ouster2rawlog/lidar_packet.h"

#include "s2s/core/error.h"

namespace s2s::tools::ouster {

namespace {

/// A little-endian number of up to 8 bytes.
std::uint64_t readBytes(const std::uint8_t* bytes, std::size_t count) {
  std::uint64_t value = 0;
  std::memcpy(&value, bytes, count);
  return value;
}

const LidarProfile* profileOf(const Metadata& metadata) {
  const auto* profile = findLidarProfile(metadata.lidarProfile);
  if (profile) return profile;
  std::string names;
  for (const auto& name : lidarProfileNames()) names += (names.empty() ? "" : ", ") + name;
  throw core::InputError("the UDP profile '" + metadata.lidarProfile + "' is not known",
                         "metadata of " + metadata.model, "record with one of these: " + names);
}

}  // namespace

LidarPacketFormat::LidarPacketFormat(const Metadata& metadata)
    : profile_(profileOf(metadata)),
      legacy_(metadata.lidarProfile == "LEGACY"),
      fusa_(metadata.fusaHeader && !legacy_),
      columnsPerPacket_(metadata.columnsPerPacket),
      packetHeaderBytes_(legacy_ ? 0 : 32),
      packetFooterBytes_(legacy_ ? 0 : 32),
      columnHeaderBytes_(legacy_ ? 16 : 12),
      columnBytes_(columnHeaderBytes_ + metadata.rows * profile_->pixelBytes + (legacy_ ? 4 : 0)) {}

std::size_t LidarPacketFormat::packetBytes() const {
  return packetHeaderBytes_ + columnsPerPacket_ * columnBytes_ + packetFooterBytes_;
}

PacketHeader LidarPacketFormat::header(const std::uint8_t* packet) const {
  if (legacy_) return {1, static_cast<std::uint32_t>(readBytes(packet + 10, 2)), 0, 0};
  if (fusa_)
    return {static_cast<std::uint32_t>(readBytes(packet, 1)), static_cast<std::uint32_t>(readBytes(packet + 4, 4)),
            static_cast<std::uint32_t>(readBytes(packet + 1, 3)), readBytes(packet + 11, 5)};
  return {static_cast<std::uint32_t>(readBytes(packet, 2)), static_cast<std::uint32_t>(readBytes(packet + 2, 2)),
          static_cast<std::uint32_t>(readBytes(packet + 4, 3)), readBytes(packet + 7, 5)};
}

ColumnHeader LidarPacketFormat::column(const std::uint8_t* packet, std::uint32_t column) const {
  const std::uint8_t* begin = columnBegin(packet, column);
  // LEGACY: a footer of all ones; later: the lowest bit of a status word.
  const bool valid =
      legacy_ ? readBytes(begin + columnBytes_ - 4, 4) == 0xffffffff : (readBytes(begin + 10, 2) & 1) != 0;
  return {readBytes(begin, 8), static_cast<std::uint32_t>(readBytes(begin + 8, 2)), valid};
}

}  // namespace s2s::tools::ouster
