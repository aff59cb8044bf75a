#include "s2s/calib/ini_patch.h"

#include <optional>
#include <sstream>
#include <vector>

namespace s2s::calib {

namespace {

const char* const kBlanks = " \t\r";

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

/// Where a comment starts, by the rules of core::IniFile: at the line's start or after a blank.
std::size_t commentStart(const std::string& line) {
  for (std::size_t i = 0; i < line.size(); ++i) {
    const bool afterBlank = i == 0 || line[i - 1] == ' ' || line[i - 1] == '\t';
    if (afterBlank && (line[i] == '#' || line[i] == ';' || line.compare(i, 2, "//") == 0)) return i;
  }
  return line.size();
}

std::string withValue(const std::string& line, const std::string& value) {
  const std::size_t comment = commentStart(line);
  const std::size_t equals = line.find('=');
  std::string tail = line.substr(comment);
  if (tail.empty() && !line.empty() && line.back() == '\r') tail = "\r";
  const std::string gap = comment < line.size() ? " " : "";
  return trimmed(line.substr(0, equals)) + " = " + value + gap + tail;
}

}  // namespace

std::string patchedIni(const std::string& text, const std::string& section, const std::string& key,
                       const std::string& value) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);

  bool inside = false;
  std::optional<std::size_t> end;  // line after the last one of the section that says something
  for (std::size_t n = 0; n < lines.size(); ++n) {
    const std::string content = trimmed(lines[n].substr(0, commentStart(lines[n])));
    if (!content.empty() && content.front() == '[') {
      inside = trimmed(content.substr(1, content.size() - 2)) == section;
      if (inside) end = n + 1;
      continue;
    }
    if (!inside || content.empty()) continue;
    end = n + 1;
    const auto equals = content.find('=');
    if (equals == std::string::npos || trimmed(content.substr(0, equals)) != key) continue;
    lines[n] = withValue(lines[n], value);
    end.reset();
    break;
  }
  const bool replaced = inside && !end;
  if (!replaced && end) lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(*end), key + " = " + value);
  if (!replaced && !end) {
    if (!lines.empty() && !trimmed(lines.back()).empty()) lines.emplace_back();
    lines.push_back("[" + section + "]");
    lines.push_back(key + " = " + value);
  }
  std::string result;
  for (const auto& line : lines) result += line + "\n";
  return result;
}

}  // namespace s2s::calib
