#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace s2s::tools {

/// What a converter read, what it left out and why. Each reason is kept once, with its count and first place.
class ConversionReport {
 public:
  struct Line {
    std::string text;  ///< plural, e.g. "LiDAR sweeps" or "packets with a wrong length"
    std::uint64_t count = 0;
    std::string firstPlace;  ///< where it happened first; may be empty
  };

  void addRead(const std::string& what, std::uint64_t count = 1);
  void addSkipped(const std::string& why, const std::string& where = {}, std::uint64_t count = 1);
  /// A remark about the whole conversion; kept once.
  void addNote(const std::string& text);

  /// How often something was read or skipped, by its text; 0 if never.
  std::uint64_t readCount(const std::string& what) const;
  std::uint64_t skippedCount(const std::string& why) const;

  const std::vector<Line>& read() const { return read_; }
  const std::vector<Line>& skipped() const { return skipped_; }
  const std::vector<std::string>& notes() const { return notes_; }

  /// Some lines for people, ending with a newline.
  std::string text() const;

 private:
  std::vector<Line> read_, skipped_;
  std::vector<std::string> notes_;
};

}  // namespace s2s::tools
