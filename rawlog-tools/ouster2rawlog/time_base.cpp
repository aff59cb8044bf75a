#include "ouster2rawlog/time_base.h"

#include <algorithm>

#include "common/converter_options.h"

namespace s2s::tools::ouster {

namespace {

/// 2001-09-09. No device has run for 31 years, and no survey is older.
constexpr std::int64_t kEarliestUnixTime = 1'000'000'000 * core::kNsPerSecond;

}  // namespace

bool TimeBaseFinder::add(const UdpDatagram& packet) {
  captureHasTime_ = captureHasTime_ && packet.captureTime_ns >= kEarliestUnixTime;
  for (std::uint32_t column = 0; column < format_.columnsPerPacket(); ++column) {
    const ColumnHeader header = format_.column(packet.payload.data(), column);
    if (!header.valid || header.time_ns > kLatestDeviceTime_ns) continue;
    const auto time_ns = static_cast<std::int64_t>(header.time_ns);
    if (first_ns_ < 0) first_ns_ = time_ns;
    fastest_ns_ = std::min(fastest_ns_, packet.captureTime_ns - time_ns);
  }
  return ++count_ < kPackets;
}

TimeBase TimeBaseFinder::result(const std::optional<core::TimeNs>& startTime) const {
  const std::int64_t first_ns = std::max<std::int64_t>(first_ns_, 0);
  const bool deviceKeepsUtc = first_ns >= kEarliestUnixTime;
  if (startTime) return {*startTime - first_ns, true, "times begin at --start-time, " + core::formatUtc(*startTime)};
  if (deviceKeepsUtc) return {0, false, "times are the sensor's own, taken as UTC"};
  if (captureHasTime_)
    return {fastest_ns_, true,
            "the sensor counts time from power-on; its clock is tied to the capture's by adding " +
                core::formatUnixTime(fastest_ns_) + " s"};
  return {kDefaultStartTime - first_ns, true,
          "neither sensor nor capture has a wall clock; times begin at " + core::formatUtc(kDefaultStartTime)};
}

}  // namespace s2s::tools::ouster
