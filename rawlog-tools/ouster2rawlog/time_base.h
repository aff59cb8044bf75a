#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "ouster2rawlog/ip_reassembly.h"
#include "ouster2rawlog/lidar_packet.h"
#include "s2s/core/time.h"

namespace s2s::tools::ouster {

/// How the device's clock is brought to UTC: by adding a constant.
struct TimeBase {
  std::int64_t offset_ns = 0;  ///< UTC minus device clock
  bool ownClock = true;        ///< false if the device keeps UTC itself
  std::string text;            ///< how the offset was found, for the report
};

/// Finds the constant from the first LiDAR packets of a capture.
///
/// A device that gets its time by PTP or GPS keeps Unix time and is believed. One that counts from power-on is tied to
/// the clock of the capturing computer by the packet that travelled fastest: the smallest difference between capture
/// time and the time of the packet's last column.
class TimeBaseFinder {
 public:
  /// Packets to look at: at 10 Hz and 64 packets a turn, some 3 seconds.
  static constexpr int kPackets = 2000;

  explicit TimeBaseFinder(const LidarPacketFormat& format) : format_(format) {}

  /// Takes a LiDAR packet; false when it has seen enough.
  bool add(const UdpDatagram& packet);

  /// @param startTime what the user wants the first column's time to be, if anything
  TimeBase result(const std::optional<core::TimeNs>& startTime) const;

 private:
  const LidarPacketFormat& format_;
  int count_ = 0;
  std::int64_t first_ns_ = -1;  // device clock at the first valid column
  std::int64_t fastest_ns_ = INT64_MAX;
  bool captureHasTime_ = true;
};

}  // namespace s2s::tools::ouster
