#include "oculus2rawlog/device_clock.h"

#include <cmath>

#include "s2s/core/time.h"

namespace s2s::tools::oculus {

namespace {

constexpr std::int64_t kWrap_ns = std::int64_t{1} << 32;

}  // namespace

std::int64_t DeviceClock::time_ns(const Ping& ping) {
  if (ping.startTime_s) return core::durationNs(*ping.startTime_s);
  std::int64_t now_ns = ping.startTime_ns;
  if (started_) {
    const std::int64_t pings = std::int64_t{ping.pingId} - lastPingId_;
    std::int64_t step_ns = static_cast<std::uint32_t>(ping.startTime_ns - static_cast<std::uint32_t>(last_ns_));
    if (period_ns_ > 0 && pings > 0) {
      const double missing = static_cast<double>(pings * period_ns_ - step_ns) / static_cast<double>(kWrap_ns);
      step_ns += kWrap_ns * static_cast<std::int64_t>(std::max(0.0, std::round(missing)));
    }
    if (pings > 0) period_ns_ = step_ns / pings;
    now_ns = last_ns_ + step_ns;
  }
  started_ = true;
  last_ns_ = now_ns;
  lastPingId_ = ping.pingId;
  return now_ns;
}

}  // namespace s2s::tools::oculus
