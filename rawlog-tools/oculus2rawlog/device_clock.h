#pragma once

#include <cstdint>
#include <optional>

#include "oculus2rawlog/ping_message.h"

namespace s2s::tools::oculus {

/// Turns the start times of pings into nanoseconds of a clock that does not wrap.
///
/// The first layout counts nanoseconds in 32 bits, so a time is known only up to multiples of 4.29 s. Between two pings
/// the multiple is the one that comes nearest to the number of pings between them (by ping number) times the last
/// period; without a period yet, the smallest.
class DeviceClock {
 public:
  /// Device time of the next ping of the stream.
  std::int64_t time_ns(const Ping& ping);

 private:
  std::int64_t last_ns_ = 0, period_ns_ = 0;
  std::uint32_t lastPingId_ = 0;
  bool started_ = false;
};

}  // namespace s2s::tools::oculus
