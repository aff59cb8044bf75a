#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace s2s::tools::ouster {

/// A UDP datagram and where it came from.
struct UdpDatagram {
  std::int64_t captureTime_ns = 0;  ///< when it was captured, Unix time; of its last fragment
  std::string source;               ///< address of the sender
  std::uint16_t sourcePort = 0, destinationPort = 0;
  std::vector<std::uint8_t> payload;
};

/// What could not become a datagram.
struct ReassemblyStatistics {
  std::uint64_t notUdp = 0;               ///< packets of other protocols
  std::uint64_t malformed = 0;            ///< packets that end too early or contradict themselves
  std::uint64_t incompleteDatagrams = 0;  ///< fragmented datagrams of which a fragment never came
};

/// Makes UDP datagrams of IPv4 and IPv6 packets. LiDAR datagrams are larger than an Ethernet frame, so that the network
/// splits them into fragments; they are put together here, at most `kMaxOpen` at a time.
class IpReassembler {
 public:
  static constexpr std::size_t kMaxOpen = 64;

  /// The datagram that this packet completes, if any.
  std::optional<UdpDatagram> add(const std::uint8_t* packet, std::size_t bytes, std::int64_t captureTime_ns);

  /// Counts the datagrams still open as incomplete; call at the end of the capture.
  void finish();

  const ReassemblyStatistics& statistics() const { return statistics_; }

 private:
  struct Fragment {
    std::string key;  ///< source, destination and identification
    std::string source;
    std::size_t offset = 0;
    bool more = false;
    const std::uint8_t* data = nullptr;
    std::size_t bytes = 0;
  };
  struct Open {
    std::vector<std::uint8_t> data;
    std::map<std::size_t, std::size_t> parts;  ///< length of each part by its offset
    std::optional<std::size_t> totalBytes;
    std::uint64_t order = 0;
  };

  std::optional<Fragment> parseV4(const std::uint8_t* packet, std::size_t bytes);
  std::optional<Fragment> parseV6(const std::uint8_t* packet, std::size_t bytes);
  std::optional<UdpDatagram> addFragment(const Fragment& fragment, std::int64_t captureTime_ns);
  std::optional<UdpDatagram> toDatagram(const std::string& source, const std::uint8_t* udp, std::size_t bytes,
                                        std::int64_t captureTime_ns);
  void dropOldest();

  std::map<std::string, Open> open_;
  std::uint64_t nextOrder_ = 0;
  ReassemblyStatistics statistics_;
};

}  // namespace s2s::tools::ouster
