#pragma once

#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "s2s/core/ini_file.h"
#include "s2s/core/transform.h"

namespace s2s::core {

/// Closed interval of allowed values.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
};
inline Range atLeast(double min) { return {min, std::numeric_limits<double>::infinity()}; }
/// The smallest double above zero, for quantities that must be positive.
inline Range positive() { return {std::numeric_limits<double>::min(), std::numeric_limits<double>::infinity()}; }

/// The keys of one INI section, bound to the variables of an options struct: key, help, limits and variable stand in
/// one place, and loading, checking and printing follow from it. The struct's defaults are the defaults.
///
/// The table refers to the variables, so it must not outlive them.
class OptionTable {
 public:
  OptionTable& add(const std::string& key, double& value, const std::string& help, Range range = {});
  OptionTable& add(const std::string& key, int& value, const std::string& help, Range range = {});
  OptionTable& add(const std::string& key, bool& value, const std::string& help);
  OptionTable& add(const std::string& key, std::string& value, const std::string& help);
  /// Degrees in the file, radians in memory; the range is in degrees, and the key should end in `_deg`.
  OptionTable& addDegrees(const std::string& key, double& value_rad, const std::string& help, Range range_deg = {});
  /// A pose as "x y z yaw_deg pitch_deg roll_deg" in metres and degrees.
  OptionTable& addPose(const std::string& key, Isometry& value, const std::string& help);
  /// Numbers separated by blanks; any count.
  OptionTable& addList(const std::string& key, std::vector<double>& values, const std::string& help);
  /// One word out of a list.
  template <class Enum>
  OptionTable& addChoice(const std::string& key, Enum& value, const std::vector<std::pair<std::string, Enum>>& words,
                         const std::string& help);
  /// Any other type: `parse` returns false if the text is no value, `expected` says what one looks like.
  OptionTable& addParsed(const std::string& key, const std::string& help, const std::string& expected,
                         std::function<bool(const std::string&)> parse, std::function<std::string()> print);

  /// Reads the keys of `section` that are present into the variables and declares the others.
  /// @throws ConfigError with file, line, section, key, value and the violated rule
  void load(IniFile& ini, const std::string& section);

  /// The section with every key's current value and its help as comment, ready to be read again.
  std::string print(const std::string& section) const;

  std::vector<std::string> keys() const;

 private:
  struct Option {
    std::string key, help, expected;
    std::function<bool(const std::string&)> parse;
    std::function<std::string()> print;
  };
  std::vector<Option> options_;
};

/// Strict readers of whole tokens: "3.5abc" and "" are refused.
bool parseDouble(const std::string& text, double& value);
bool parseInt(const std::string& text, int& value);
bool parseBool(const std::string& text, bool& value);
/// "x y z yaw_deg pitch_deg roll_deg".
bool parsePose(const std::string& text, Isometry& value);
std::string printPose(const Isometry& T);
/// Shortest decimal text that reads back to the same double.
std::string printDouble(double value);

template <class Enum>
OptionTable& OptionTable::addChoice(const std::string& key, Enum& value,
                                    const std::vector<std::pair<std::string, Enum>>& words, const std::string& help) {
  std::string expected = "one of";
  for (const auto& [word, meaning] : words) expected += " " + word;
  return addParsed(
      key, help, expected,
      [&value, words](const std::string& text) {
        for (const auto& [word, meaning] : words)
          if (word == text) {
            value = meaning;
            return true;
          }
        return false;
      },
      [&value, words] {
        for (const auto& [word, meaning] : words)
          if (meaning == value) return word;
        return std::string("?");
      });
}

}  // namespace s2s::core
