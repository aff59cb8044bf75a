#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

namespace s2s::mapper {

/// Counts data faults by kind and keeps where each kind was first met, so that a survey with ten thousand bad records
/// gives one line in the log and in `summary.json`. A hundred kinds are told apart, all others count as one. Safe to
/// use from several threads.
class FaultLog {
 public:
  /// @param kind  what is wrong, the same text for all faults of a kind
  /// @param where first place, e.g. record and time; kept for the first fault only
  /// @return true if it is the first of its kind
  bool add(const std::string& kind, const std::string& where = {}, std::uint64_t count = 1);

  /// "kind (N times, first: where)" for each kind, in order of first appearance.
  std::vector<std::string> lines() const;

 private:
  struct Entry {
    std::string kind, where;
    std::uint64_t count = 0;
  };
  mutable std::mutex mutex_;
  std::vector<Entry> entries_;
};

}  // namespace s2s::mapper
