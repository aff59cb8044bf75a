#include "s2s/core/ini_file.h"

#include <algorithm>
#include <fstream>
#include <numeric>
#include <sstream>

#include "s2s/core/error.h"

namespace s2s::core {

namespace {

std::string trimmed(const std::string& text) {
  const char* blanks = " \t\r";
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

bool startsComment(const std::string& text, std::size_t i) {
  return text[i] == '#' || text[i] == ';' || text.compare(i, 2, "//") == 0;
}

/// A comment starts a line or follows a blank, so that "http://x" and "a;b" stay whole.
std::string withoutComment(const std::string& line) {
  for (std::size_t i = 0; i < line.size(); ++i) {
    const bool afterBlank = i == 0 || line[i - 1] == ' ' || line[i - 1] == '\t';
    if (afterBlank && startsComment(line, i)) return line.substr(0, i);
  }
  return line;
}

std::size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row[b.size()];
}

std::string suggestion(const std::string& word, const std::vector<std::string>& candidates) {
  const std::string nearest = nearestWord(word, candidates);
  if (!nearest.empty()) return "did you mean '" + nearest + "'?";
  std::string list = "known here: ";
  for (std::size_t i = 0; i < candidates.size(); ++i) list += (i ? ", " : "") + candidates[i];
  return candidates.empty() ? "remove it" : list;
}

}  // namespace

std::string nearestWord(const std::string& word, const std::vector<std::string>& candidates) {
  std::string best;
  std::size_t bestDistance = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const auto& candidate : candidates) {
    const std::size_t distance = editDistance(word, candidate);
    if (distance < bestDistance) {
      best = candidate;
      bestDistance = distance;
    }
  }
  return best;
}

IniFile IniFile::load(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw ConfigError("cannot open the configuration file", path, "check the path given with --config");
  std::ostringstream text;
  text << file.rdbuf();
  if (file.bad() || text.fail())
    throw ConfigError("cannot read the configuration file", path, "give an INI file, not a folder");
  return parse(text.str(), path);
}

IniFile IniFile::parse(const std::string& text, const std::string& name) {
  IniFile ini;
  ini.name_ = name;
  std::istringstream lines(text);
  std::string raw, section;
  for (int number = 1; std::getline(lines, raw); ++number) {
    const std::string line = trimmed(withoutComment(raw));
    const std::string where = name + ":" + std::to_string(number);
    if (line.empty()) continue;
    if (line.front() == '[') {
      if (line.back() != ']' || line.size() < 3)
        throw ConfigError("'" + line + "' is not a section header", where, "write [section]");
      section = trimmed(line.substr(1, line.size() - 2));
      if (!ini.sections_.emplace(section, Section{}).second)
        throw ConfigError("section [" + section + "] stands twice", where, "merge the two");
      continue;
    }
    const auto equals = line.find('=');
    if (equals == std::string::npos || equals == 0)
      throw ConfigError("'" + line + "' is neither a section nor 'key = value'", where, "correct or remove the line");
    if (section.empty()) throw ConfigError("a key stands before any section", where, "put a [section] above it");
    const std::string key = trimmed(line.substr(0, equals));
    if (!ini.sections_[section].emplace(key, Entry{trimmed(line.substr(equals + 1)), number}).second)
      throw ConfigError("key '" + key + "' stands twice in [" + section + "]", where, "keep one of them");
  }
  return ini;
}

std::vector<std::string> IniFile::sectionsStartingWith(const std::string& prefix) const {
  std::vector<std::string> names;
  for (const auto& [name, entries] : sections_)
    if (name.compare(0, prefix.size(), prefix) == 0) names.push_back(name);
  return names;
}

const IniFile::Section& IniFile::section(const std::string& section) const {
  static const Section kEmpty;
  const auto found = sections_.find(section);
  return found == sections_.end() ? kEmpty : found->second;
}

std::optional<IniFile::Entry> IniFile::read(const std::string& section, const std::string& key) {
  declared_[section].insert(key);
  const auto& entries = this->section(section);
  const auto found = entries.find(key);
  if (found == entries.end()) return std::nullopt;
  return found->second;
}

void IniFile::declare(const std::string& section, const std::vector<std::string>& keys) {
  declared_[section].insert(keys.begin(), keys.end());
}

void IniFile::set(const std::string& section, const std::string& key, const std::string& value) {
  sections_[section][key] = Entry{value, 0};
}

void IniFile::rejectUnread(const std::string& prefix) const {
  for (const auto& [section, entries] : sections_) {
    if (section.compare(0, prefix.size(), prefix) != 0) continue;
    const auto known = declared_.find(section);
    if (known == declared_.end()) {
      std::vector<std::string> names;
      for (const auto& [name, keys] : declared_) names.push_back(name);
      throw ConfigError("unknown section [" + section + "]", name_, suggestion(section, names));
    }
    for (const auto& [key, entry] : entries)
      if (known->second.count(key) == 0)
        throw ConfigError("unknown key '" + key + "'", where(section, key),
                          suggestion(key, {known->second.begin(), known->second.end()}));
  }
}

std::string IniFile::where(const std::string& section, const std::string& key) const {
  const auto& entries = this->section(section);
  const auto found = entries.find(key);
  const std::string line =
      found != entries.end() && found->second.line > 0 ? ":" + std::to_string(found->second.line) : "";
  return name_ + line + " [" + section + "] " + key;
}

}  // namespace s2s::core
