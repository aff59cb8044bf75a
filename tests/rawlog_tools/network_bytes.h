#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "byte_writer.h"

namespace s2s::test {

inline std::string bigEndian16(std::size_t value) {
  return {static_cast<char>(value >> 8 & 0xff), static_cast<char>(value & 0xff)};
}

/// A UDP header and its payload.
inline std::string udp(const std::string& payload, std::uint16_t destinationPort = 7502) {
  return bigEndian16(40000) + bigEndian16(destinationPort) + bigEndian16(8 + payload.size()) + bigEndian16(0) + payload;
}

/// An IPv4 packet from 10.0.0.`host` that carries a part of a datagram from `offset` on.
inline std::string ipv4(const std::string& part, std::uint16_t id = 1, std::size_t offset = 0, bool more = false,
                        std::uint8_t protocol = 17, std::uint8_t host = 5) {
  std::string packet = std::string("\x45\0", 2) + bigEndian16(20 + part.size()) + bigEndian16(id) +
                       bigEndian16(offset / 8 + (more ? 0x2000 : 0)) + "\x40";
  packet += static_cast<char>(protocol);
  packet += bigEndian16(0);
  packet += std::string("\x0a\0\0", 3) + static_cast<char>(host) + std::string("\x0a\0\0\x01", 4);
  return packet + part;
}

/// The IPv4 packets of a datagram that is split after every `size` bytes (a multiple of 8).
inline std::vector<std::string> fragments(const std::string& datagram, std::size_t size, std::uint16_t id = 1) {
  std::vector<std::string> packets;
  for (std::size_t at = 0; at < datagram.size(); at += size)
    packets.push_back(ipv4(datagram.substr(at, size), id, at, at + size < datagram.size()));
  return packets;
}

inline std::string ethernet(const std::string& packet) {
  return std::string(12, '\x02') + std::string("\x08\0", 2) + packet;
}

/// A pcap file (microseconds, little-endian) of these frames, a millisecond apart.
inline std::string pcap(const std::vector<std::string>& frames, std::uint32_t linkType = 1,
                        std::uint32_t firstSecond = 1'700'000'000) {
  ByteWriter file;
  file.add(0xa1b2c3d4u).add(std::uint16_t{2}).add(std::uint16_t{4}).add(0u).add(0u).add(262144u).add(linkType);
  for (std::uint32_t i = 0; i < frames.size(); ++i) {
    const auto length = static_cast<std::uint32_t>(frames[i].size());
    file.add(firstSecond + i / 1000).add(i % 1000 * 1000).add(length).add(length).add(frames[i]);
  }
  return file.bytes();
}

}  // namespace s2s::test
