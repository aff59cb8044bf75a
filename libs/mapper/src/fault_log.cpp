#include "s2s/mapper/fault_log.h"

#include <algorithm>

namespace s2s::mapper {

bool FaultLog::add(const std::string& kind, const std::string& where, std::uint64_t count) {
  if (count == 0) return false;
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto known = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.kind == kind; });
  if (known != entries_.end()) {
    known->count += count;
    return false;
  }
  entries_.push_back({kind, where, count});
  return true;
}

std::vector<std::string> FaultLog::lines() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<std::string> lines;
  for (const Entry& e : entries_) {
    std::string line = e.kind;
    if (e.count > 1)
      line += " (" + std::to_string(e.count) + " times" + (e.where.empty() ? "" : ", first: " + e.where) + ")";
    else if (!e.where.empty())
      line += " (" + e.where + ")";
    lines.push_back(line);
  }
  return lines;
}

}  // namespace s2s::mapper
