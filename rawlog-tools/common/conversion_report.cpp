#include "common/conversion_report.h"

#include <algorithm>

namespace s2s::tools {

namespace {

void add(std::vector<ConversionReport::Line>& lines, const std::string& text, const std::string& where,
         std::uint64_t count) {
  const auto found = std::find_if(lines.begin(), lines.end(), [&](const auto& line) { return line.text == text; });
  if (found != lines.end())
    found->count += count;
  else
    lines.push_back({text, count, where});
}

std::uint64_t countOf(const std::vector<ConversionReport::Line>& lines, const std::string& text) {
  for (const auto& line : lines)
    if (line.text == text) return line.count;
  return 0;
}

}  // namespace

void ConversionReport::addRead(const std::string& what, std::uint64_t count) { add(read_, what, {}, count); }

void ConversionReport::addSkipped(const std::string& why, const std::string& where, std::uint64_t count) {
  add(skipped_, why, where, count);
}

void ConversionReport::addNote(const std::string& text) {
  if (std::find(notes_.begin(), notes_.end(), text) == notes_.end()) notes_.push_back(text);
}

std::uint64_t ConversionReport::readCount(const std::string& what) const { return countOf(read_, what); }

std::uint64_t ConversionReport::skippedCount(const std::string& why) const { return countOf(skipped_, why); }

std::string ConversionReport::text() const {
  std::string text;
  for (const auto& line : read_) text += "read     " + std::to_string(line.count) + " " + line.text + "\n";
  for (const auto& line : skipped_) {
    text += "skipped  " + std::to_string(line.count) + " " + line.text;
    if (!line.firstPlace.empty()) text += (line.count > 1 ? " (first: " : " (") + line.firstPlace + ")";
    text += "\n";
  }
  if (skipped_.empty()) text += "skipped  nothing\n";
  for (const auto& note : notes_) text += "note     " + note + "\n";
  return text;
}

}  // namespace s2s::tools
