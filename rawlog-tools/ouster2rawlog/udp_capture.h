#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "ouster2rawlog/ip_reassembly.h"

namespace s2s::tools::ouster {

/// Reads the UDP datagrams of a pcap or pcapng file one after the other. Link types: Ethernet (with VLAN tags), Linux
/// cooked (both versions), BSD loopback and raw IP.
class UdpCapture {
 public:
  /// @throws core::InputError if the file cannot be opened, is no capture, or has another link type
  explicit UdpCapture(const std::string& path);
  ~UdpCapture();
  UdpCapture(const UdpCapture&) = delete;
  UdpCapture& operator=(const UdpCapture&) = delete;

  /// Nothing at the end, see `fault`.
  std::optional<UdpDatagram> next();

  const ReassemblyStatistics& statistics() const { return reassembler_.statistics(); }
  /// Packets of which the capture holds only the beginning (recorded with too small a snapshot length).
  std::uint64_t cutPackets() const { return cutPackets_; }
  /// Why reading ended before the end of the file; empty if it did not.
  const std::string& fault() const { return fault_; }
  /// Share of the file that has been read, in [0, 1].
  double shareRead() const;

 private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
  IpReassembler reassembler_;
  std::uint64_t cutPackets_ = 0;
  std::string fault_;
};

}  // namespace s2s::tools::ouster
