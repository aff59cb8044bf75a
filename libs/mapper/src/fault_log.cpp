#include "s2s/mapper/fault_log.h"

#include <algorithm>

namespace s2s::mapper {

namespace {

/// Texts that name a value may differ from record to record, and a damaged recording has millions.
constexpr std::size_t kMostKinds = 100;
const char* const kFurther = "further kinds of faults";

}  // namespace

bool FaultLog::add(const std::string& kind, const std::string& where, std::uint64_t count) {
  if (count == 0) return false;
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto known = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.kind == kind; });
  if (known != entries_.end()) {
    known->count += count;
    return false;
  }
  if (entries_.size() < kMostKinds) {
    entries_.push_back({kind, where, count});
    return true;
  }
  if (entries_.size() == kMostKinds) entries_.push_back({kFurther, where, 0});
  entries_.back().count += count;
  return false;
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
