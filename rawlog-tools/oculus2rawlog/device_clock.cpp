#include "oculus2rawlog/device_clock.h"

#include <algorithm>
#include <cmath>

#include "s2s/core/time.h"

namespace s2s::tools::oculus {

namespace {

constexpr std::int64_t kWrap_ns = std::int64_t{1} << 32;
/// Longer pauses are not bridged: a ping number so far ahead is damage.
constexpr double kLongestPause_ns = 86'400e9;

}  // namespace

std::int64_t DeviceClock::time_ns(const Ping& ping) {
  if (ping.startTime_s) return core::durationNs(*ping.startTime_s);
  std::int64_t now_ns = ping.startTime_ns;
  if (started_) {
    const std::int64_t pings = std::int64_t{ping.pingId} - lastPingId_;
    std::int64_t step_ns = static_cast<std::uint32_t>(ping.startTime_ns - static_cast<std::uint32_t>(last_ns_));
    const double expected_ns = static_cast<double>(pings) * static_cast<double>(period_ns_);
    if (expected_ns > 0 && expected_ns < kLongestPause_ns)
      step_ns += kWrap_ns * std::llround(std::max(0.0, (expected_ns - static_cast<double>(step_ns)) / kWrap_ns));
    if (pings > 0) period_ns_ = step_ns / pings;
    now_ns = last_ns_ + step_ns;
  }
  started_ = true;
  last_ns_ = now_ns;
  lastPingId_ = ping.pingId;
  return now_ns;
}

}  // namespace s2s::tools::oculus
