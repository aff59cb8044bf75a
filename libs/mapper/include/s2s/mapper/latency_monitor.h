#pragma once

#include <array>
#include <chrono>
#include <deque>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "s2s/core/time.h"
#include "s2s/mapper/sensor_router.h"

namespace s2s::mapper {

/// How long things took from handing over a record until they were done: median, 95th percentile and largest.
struct LatencyStatistics {
  std::string name;
  std::size_t count = 0;
  double median_s = 0, p95_s = 0, max_s = 0;
};

/// Collects latencies of a run at the recorded rate. Safe to use from several threads.
class LatencyMonitor {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param enabled false: nothing is kept
  explicit LatencyMonitor(bool enabled) : enabled_(enabled) {}
  bool enabled() const { return enabled_; }

  /// A record of this time was handed over just now.
  void arrived(Role role, core::TimeNs time);
  /// What was wanted of that record is done just now. A record that did not arrive is passed over.
  void done(const std::string& name, Role role, core::TimeNs time);
  /// A latency measured elsewhere.
  void add(const std::string& name, Clock::duration latency);

  /// In order of name.
  std::vector<LatencyStatistics> statistics() const;

 private:
  using Arrival = std::pair<core::TimeNs, Clock::time_point>;

  const bool enabled_;
  mutable std::mutex mutex_;
  std::array<std::deque<Arrival>, kRoleCount> arrivals_;
  std::map<std::string, std::vector<double>> latencies_s_;
};

}  // namespace s2s::mapper
