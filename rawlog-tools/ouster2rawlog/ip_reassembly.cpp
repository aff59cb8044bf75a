#include "ouster2rawlog/ip_reassembly.h"

#include <arpa/inet.h>

#include <algorithm>
#include <cstring>

namespace s2s::tools::ouster {

namespace {

constexpr std::uint8_t kUdp = 17;
constexpr std::uint8_t kV6Fragment = 44;
constexpr std::size_t kMaxDatagram = 65535;

std::size_t bigEndian16(const std::uint8_t* bytes) { return static_cast<std::size_t>(bytes[0]) << 8 | bytes[1]; }

std::string addressText(int family, const std::uint8_t* address) {
  char text[INET6_ADDRSTRLEN] = "?";
  inet_ntop(family, address, text, sizeof text);
  return text;
}

std::string bytesText(const std::uint8_t* bytes, std::size_t count) {
  return {reinterpret_cast<const char*>(bytes), count};
}

}  // namespace

std::optional<UdpDatagram> IpReassembler::add(const std::uint8_t* packet, std::size_t bytes,
                                              std::int64_t captureTime_ns) {
  if (bytes == 0) {
    ++statistics_.malformed;
    return std::nullopt;
  }
  const unsigned version = packet[0] >> 4;
  if (version != 4 && version != 6) {
    ++statistics_.notUdp;
    return std::nullopt;
  }
  const auto fragment = version == 4 ? parseV4(packet, bytes) : parseV6(packet, bytes);
  if (!fragment) return std::nullopt;
  if (fragment->offset == 0 && !fragment->more)
    return toDatagram(fragment->source, fragment->data, fragment->bytes, captureTime_ns);
  return addFragment(*fragment, captureTime_ns);
}

std::optional<IpReassembler::Fragment> IpReassembler::parseV4(const std::uint8_t* packet, std::size_t bytes) {
  const std::size_t headerBytes = 4u * (packet[0] & 0x0f);
  if (bytes < 20 || headerBytes < 20 || bytes < headerBytes) {
    ++statistics_.malformed;
    return std::nullopt;
  }
  if (packet[9] != kUdp) {
    ++statistics_.notUdp;
    return std::nullopt;
  }
  // Segmentation offload leaves the total length 0; Ethernet pads short packets beyond it.
  const std::size_t total = bigEndian16(packet + 2) == 0 ? bytes : bigEndian16(packet + 2);
  if (total < headerBytes || total > bytes) {
    ++statistics_.malformed;
    return std::nullopt;
  }
  Fragment fragment;
  fragment.key = bytesText(packet + 12, 8) + bytesText(packet + 4, 2);
  fragment.source = addressText(AF_INET, packet + 12);
  fragment.offset = 8 * (bigEndian16(packet + 6) & 0x1fff);
  fragment.more = (packet[6] & 0x20) != 0;
  fragment.data = packet + headerBytes;
  fragment.bytes = total - headerBytes;
  return fragment;
}

std::optional<IpReassembler::Fragment> IpReassembler::parseV6(const std::uint8_t* packet, std::size_t bytes) {
  constexpr std::size_t kHeader = 40, kFragmentHeader = 8;
  if (bytes < kHeader || bytes < kHeader + bigEndian16(packet + 4)) {
    ++statistics_.malformed;
    return std::nullopt;
  }
  Fragment fragment;
  fragment.source = addressText(AF_INET6, packet + 8);
  fragment.data = packet + kHeader;
  fragment.bytes = bigEndian16(packet + 4);
  std::uint8_t next = packet[6];
  if (next == kV6Fragment && fragment.bytes >= kFragmentHeader) {
    const std::uint8_t* header = fragment.data;
    next = header[0];
    fragment.offset = bigEndian16(header + 2) & 0xfff8;
    fragment.more = (header[3] & 1) != 0;
    fragment.key = bytesText(packet + 8, 32) + bytesText(header + 4, 4);
    fragment.data += kFragmentHeader;
    fragment.bytes -= kFragmentHeader;
  }
  if (next != kUdp) {
    ++statistics_.notUdp;
    return std::nullopt;
  }
  return fragment;
}

std::optional<UdpDatagram> IpReassembler::addFragment(const Fragment& fragment, std::int64_t captureTime_ns) {
  if (fragment.offset + fragment.bytes > kMaxDatagram) {
    ++statistics_.malformed;
    return std::nullopt;
  }
  if (open_.count(fragment.key) == 0 && open_.size() >= kMaxOpen) dropOldest();
  Open& open = open_[fragment.key];
  if (open.parts.empty()) open.order = nextOrder_++;
  const std::size_t end = fragment.offset + fragment.bytes;
  if (open.data.size() < end) open.data.resize(end);
  std::copy_n(fragment.data, fragment.bytes, open.data.begin() + static_cast<std::ptrdiff_t>(fragment.offset));
  open.parts[fragment.offset] = std::max(open.parts[fragment.offset], fragment.bytes);
  if (!fragment.more) open.totalBytes = end;
  if (!open.totalBytes) return std::nullopt;

  std::size_t covered = 0;
  for (const auto& [offset, length] : open.parts) {
    if (offset > covered) return std::nullopt;
    covered = std::max(covered, offset + length);
  }
  if (covered < *open.totalBytes) return std::nullopt;
  auto datagram = toDatagram(fragment.source, open.data.data(), *open.totalBytes, captureTime_ns);
  open_.erase(fragment.key);
  return datagram;
}

std::optional<UdpDatagram> IpReassembler::toDatagram(const std::string& source, const std::uint8_t* udp,
                                                     std::size_t bytes, std::int64_t captureTime_ns) {
  constexpr std::size_t kHeader = 8;
  const std::size_t length = bytes < kHeader ? 0 : bigEndian16(udp + 4);
  if (bytes < kHeader || (length != 0 && (length < kHeader || length > bytes))) {
    ++statistics_.malformed;
    return std::nullopt;
  }
  UdpDatagram datagram;
  datagram.captureTime_ns = captureTime_ns;
  datagram.source = source;
  datagram.sourcePort = static_cast<std::uint16_t>(bigEndian16(udp));
  datagram.destinationPort = static_cast<std::uint16_t>(bigEndian16(udp + 2));
  datagram.payload.assign(udp + kHeader, udp + (length == 0 ? bytes : length));
  return datagram;
}

void IpReassembler::dropOldest() {
  const auto oldest = std::min_element(open_.begin(), open_.end(),
                                       [](const auto& a, const auto& b) { return a.second.order < b.second.order; });
  open_.erase(oldest);
  ++statistics_.incompleteDatagrams;
}

void IpReassembler::finish() {
  statistics_.incompleteDatagrams += open_.size();
  open_.clear();
}

}  // namespace s2s::tools::ouster
