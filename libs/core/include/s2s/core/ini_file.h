#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace s2s::core {

/// A configuration in MRPT's INI syntax, read strictly.
///
/// MRPT's own reader takes a missing file as defaults, `true ; note` as false and ignores misspelled keys; this one
/// demands that the file exists, that every line parses, that no key stands twice, and that every section and key is
/// known to somebody (`rejectUnread`). Comments start with `//`, `#` or `;`, at the line's start or after a blank.
class IniFile {
 public:
  struct Entry {
    std::string value;
    int line = 0;
  };
  using Section = std::map<std::string, Entry>;

  /// @throws ConfigError if the file is missing or a line does not parse
  static IniFile load(const std::string& path);
  /// The same from text; `name` stands for the file in errors.
  static IniFile parse(const std::string& text, const std::string& name);

  const std::string& name() const { return name_; }
  /// Names of sections starting with `prefix`, in alphabetical order.
  std::vector<std::string> sectionsStartingWith(const std::string& prefix) const;
  /// The entries of a section; an absent one is empty.
  const Section& section(const std::string& section) const;

  /// The value of a key and a mark that it was read; nothing if absent.
  std::optional<Entry> read(const std::string& section, const std::string& key);
  /// Says that a section and these keys are known, read or not; they serve as suggestions in `rejectUnread`.
  void declare(const std::string& section, const std::vector<std::string>& keys);

  /// Sets or replaces a value, as a command line does with `--set section.key=value`.
  void set(const std::string& section, const std::string& key, const std::string& value);

  /// @param prefix only sections that start so are looked at; others belong to another program
  /// @throws ConfigError naming the first section or key that nobody declared, and the nearest one that exists
  void rejectUnread(const std::string& prefix = "") const;

  /// "file.ini:12 [section] key" for messages.
  std::string where(const std::string& section, const std::string& key) const;

 private:
  std::string name_;
  std::map<std::string, Section> sections_;
  std::map<std::string, std::set<std::string>> declared_;
};

/// The candidate with the smallest edit distance to `word`; empty if none is near.
std::string nearestWord(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace s2s::core
