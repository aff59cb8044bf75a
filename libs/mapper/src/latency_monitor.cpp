#include "s2s/mapper/latency_monitor.h"

#include <algorithm>
#include <cmath>

namespace s2s::mapper {

namespace {

/// Arrivals kept for each role: more than any pipeline holds back.
constexpr std::size_t kRemembered = 2000;

double quantile(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(std::lround(share * static_cast<double>(sorted.size() - 1)))];
}

}  // namespace

void LatencyMonitor::arrived(Role role, core::TimeNs time) {
  if (!enabled_ || role == Role::None) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  auto& arrivals = arrivals_[static_cast<std::size_t>(role)];
  arrivals.emplace_back(time, Clock::now());
  if (arrivals.size() > kRemembered) arrivals.pop_front();
}

void LatencyMonitor::done(const std::string& name, Role role, core::TimeNs time) {
  if (!enabled_ || role == Role::None) return;
  const auto now = Clock::now();
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto& arrivals = arrivals_[static_cast<std::size_t>(role)];
  const auto found = std::lower_bound(arrivals.begin(), arrivals.end(), time,
                                      [](const Arrival& arrival, core::TimeNs t) { return arrival.first < t; });
  if (found == arrivals.end() || found->first != time) return;
  latencies_s_[name].push_back(std::chrono::duration<double>(now - found->second).count());
}

void LatencyMonitor::add(const std::string& name, Clock::duration latency) {
  if (!enabled_) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  latencies_s_[name].push_back(std::chrono::duration<double>(latency).count());
}

std::vector<LatencyStatistics> LatencyMonitor::statistics() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<LatencyStatistics> all;
  for (auto [name, values] : latencies_s_) {
    std::sort(values.begin(), values.end());
    all.push_back({name, values.size(), quantile(values, 0.5), quantile(values, 0.95), values.back()});
  }
  return all;
}

}  // namespace s2s::mapper
