#include "s2s/core/option_table.h"

#include <charconv>
#include <cmath>
#include <sstream>

#include "s2s/core/error.h"

namespace s2s::core {

namespace {

constexpr double kDegPerRad = 180.0 / M_PI;

template <class Number>
bool parseWhole(const std::string& text, Number& value) {
  const char* begin = text.data();
  const char* end = begin + text.size();
  if (end - begin > 1 && begin[0] == '+' && begin[1] != '-') ++begin;
  Number parsed{};
  const auto result = std::from_chars(begin, end, parsed);
  if (result.ec != std::errc() || result.ptr != end) return false;
  value = parsed;
  return true;
}

std::string describe(const Range& range, const std::string& kind) {
  std::string text = kind;
  if (range.min == positive().min && std::isinf(range.max)) return text + " above 0";
  if (std::isfinite(range.min)) text += ", at least " + printDouble(range.min);
  if (std::isfinite(range.max)) text += ", at most " + printDouble(range.max);
  return text;
}

double roundedDegrees(double rad) { return std::round(rad * kDegPerRad * 1e9) / 1e9; }

/// Degrees that read back to the same radians: nine decimals where they do (45, not 45.000000000000007), else all.
double niceDegrees(double rad) {
  const double exact = rad * kDegPerRad;
  const double rounded = roundedDegrees(rad);
  for (const double candidate : {rounded, exact, std::nextafter(exact, 0.0), std::nextafter(exact, 2 * exact)})
    if (candidate / kDegPerRad == rad) return candidate;
  return rounded;
}

}  // namespace

bool parseDouble(const std::string& text, double& value) {
  double parsed = 0;
  if (!parseWhole(text, parsed) || !std::isfinite(parsed)) return false;
  value = parsed;
  return true;
}

bool parseInt(const std::string& text, int& value) { return parseWhole(text, value); }

bool parseBool(const std::string& text, bool& value) {
  const bool yes = text == "true" || text == "yes" || text == "on" || text == "1";
  const bool no = text == "false" || text == "no" || text == "off" || text == "0";
  if (yes || no) value = yes;
  return yes || no;
}

bool parsePose(const std::string& text, Isometry& value) {
  std::istringstream words(text);
  std::string word;
  std::vector<double> numbers;
  while (words >> word) {
    double number = 0;
    if (!parseDouble(word, number)) return false;
    numbers.push_back(number);
  }
  if (numbers.size() != 6) return false;
  value = isometryFromXyzYpr(numbers[0], numbers[1], numbers[2], numbers[3] / kDegPerRad, numbers[4] / kDegPerRad,
                             numbers[5] / kDegPerRad);
  return true;
}

std::string printPose(const Isometry& T) {
  const auto pose = toPose(T);
  std::string text;
  for (const double metres : {pose.x(), pose.y(), pose.z()}) text += printDouble(metres) + " ";
  // The angles come out of a matrix, which holds them to some 1e-16 only.
  return text + printDouble(roundedDegrees(pose.yaw())) + " " + printDouble(roundedDegrees(pose.pitch())) + " " +
         printDouble(roundedDegrees(pose.roll()));
}

std::string printDouble(double value) {
  if (value == 0) return "0";
  char text[40];
  const auto result = std::to_chars(text, text + sizeof text, value);
  return {text, result.ptr};
}

OptionTable& OptionTable::addParsed(const std::string& key, const std::string& help, const std::string& expected,
                                    std::function<bool(const std::string&)> parse, std::function<std::string()> print) {
  options_.push_back({key, help, expected, std::move(parse), std::move(print)});
  return *this;
}

OptionTable& OptionTable::add(const std::string& key, double& value, const std::string& help, Range range) {
  return addParsed(
      key, help, describe(range, "a number"),
      [&value, range](const std::string& text) {
        double parsed = 0;
        if (!parseDouble(text, parsed) || parsed < range.min || parsed > range.max) return false;
        value = parsed;
        return true;
      },
      [&value] { return printDouble(value); });
}

OptionTable& OptionTable::add(const std::string& key, int& value, const std::string& help, Range range) {
  return addParsed(
      key, help, describe(range, "a whole number"),
      [&value, range](const std::string& text) {
        int parsed = 0;
        if (!parseInt(text, parsed) || parsed < range.min || parsed > range.max) return false;
        value = parsed;
        return true;
      },
      [&value] { return std::to_string(value); });
}

OptionTable& OptionTable::add(const std::string& key, bool& value, const std::string& help) {
  return addParsed(
      key, help, "true or false", [&value](const std::string& text) { return parseBool(text, value); },
      [&value] { return std::string(value ? "true" : "false"); });
}

OptionTable& OptionTable::add(const std::string& key, std::string& value, const std::string& help) {
  return addParsed(
      key, help, "a text",
      [&value](const std::string& text) {
        value = text;
        return true;
      },
      [&value] { return value; });
}

OptionTable& OptionTable::addDegrees(const std::string& key, double& value_rad, const std::string& help,
                                     Range range_deg) {
  return addParsed(
      key, help, describe(range_deg, "an angle in degrees"),
      [&value_rad, range_deg](const std::string& text) {
        double parsed = 0;
        if (!parseDouble(text, parsed) || parsed < range_deg.min || parsed > range_deg.max) return false;
        value_rad = parsed / kDegPerRad;
        return true;
      },
      [&value_rad] { return printDouble(niceDegrees(value_rad)); });
}

OptionTable& OptionTable::addPose(const std::string& key, Isometry& value, const std::string& help) {
  return addParsed(
      key, help, "six numbers: x y z [m] yaw pitch roll [deg]",
      [&value](const std::string& text) { return parsePose(text, value); }, [&value] { return printPose(value); });
}

OptionTable& OptionTable::addList(const std::string& key, std::vector<double>& values, const std::string& help) {
  return addParsed(
      key, help, "numbers separated by blanks",
      [&values](const std::string& text) {
        std::istringstream words(text);
        std::vector<double> parsed;
        for (std::string word; words >> word;) {
          double number = 0;
          if (!parseDouble(word, number)) return false;
          parsed.push_back(number);
        }
        values = parsed;
        return true;
      },
      [&values] {
        std::string text;
        for (const double value : values) text += (text.empty() ? "" : " ") + printDouble(value);
        return text;
      });
}

void OptionTable::load(IniFile& ini, const std::string& section) {
  ini.declare(section, keys());
  for (auto& option : options_) {
    const auto entry = ini.read(section, option.key);
    if (!entry || option.parse(entry->value)) continue;
    throw ConfigError("'" + entry->value + "' is not a valid value", ini.where(section, option.key),
                      "give " + option.expected + " (" + option.help + ")");
  }
}

std::string OptionTable::print(const std::string& section) const {
  std::string text = "[" + section + "]\n";
  for (const auto& option : options_) text += "// " + option.help + "\n" + option.key + " = " + option.print() + "\n";
  return text;
}

std::vector<std::string> OptionTable::keys() const {
  std::vector<std::string> names;
  for (const auto& option : options_) names.push_back(option.key);
  return names;
}

}  // namespace s2s::core
