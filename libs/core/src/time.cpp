#include "s2s/core/time.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <limits>

#include "s2s/core/error.h"

namespace s2s::core {

namespace {

constexpr std::int64_t kTicksFrom1601To1970 = 116'444'736'000'000'000LL;
constexpr std::int64_t kNsPerTick = 100;

std::int64_t floorDiv(std::int64_t a, std::int64_t b) { return a / b - (a % b != 0 && (a < 0) != (b < 0) ? 1 : 0); }

/// The decimals of a second ("123" -> 123'000'000); false if there is anything but 1 to 9 digits.
bool parseFraction(const std::string& digits, TimeNs& ns) {
  if (digits.empty() || digits.size() > 9) return false;
  ns = 0;
  for (std::size_t i = 0; i < 9; ++i) {
    const char c = i < digits.size() ? digits[i] : '0';
    if (c < '0' || c > '9') return false;
    ns = ns * 10 + (c - '0');
  }
  return true;
}

std::string dateText(std::time_t seconds) {
  std::tm tm{};
  gmtime_r(&seconds, &tm);
  char text[40];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &tm);
  return text;
}

bool parseUnixTime(const std::string& text, TimeNs& t) {
  const auto dot = text.find('.');
  const std::string whole = text.substr(0, dot);
  if (whole.empty() || whole.size() > 10 || whole.find_first_not_of("0123456789") != std::string::npos) return false;
  TimeNs fraction = 0;
  if (dot != std::string::npos && !parseFraction(text.substr(dot + 1), fraction)) return false;
  const std::int64_t seconds = std::stoll(whole);
  if (seconds >= std::numeric_limits<TimeNs>::max() / kNsPerSecond) return false;
  t = seconds * kNsPerSecond + fraction;
  return true;
}

bool parseUtc(std::string text, TimeNs& t) {
  if (text.empty() || text.back() != 'Z') return false;
  text.pop_back();
  TimeNs fraction = 0;
  if (const auto dot = text.find('.'); dot != std::string::npos) {
    if (!parseFraction(text.substr(dot + 1), fraction)) return false;
    text.resize(dot);
  }
  std::tm tm{};
  int used = 0;
  if (std::sscanf(text.c_str(), "%4d-%2d-%2dT%2d:%2d:%2d%n", &tm.tm_year, &tm.tm_mon, &tm.tm_mday, &tm.tm_hour,
                  &tm.tm_min, &tm.tm_sec, &used) != 6 ||
      static_cast<std::size_t>(used) != text.size())
    return false;
  tm.tm_year -= 1900;
  tm.tm_mon -= 1;
  const std::time_t seconds = timegm(&tm);  // carries a 13th month or a 61st second over: such a text is no time
  if (dateText(seconds) != text) return false;
  t = static_cast<TimeNs>(seconds) * kNsPerSecond + fraction;
  return true;
}

}  // namespace

TimeNs fromMrptTime(mrpt::Clock::time_point t) {
  constexpr std::int64_t kMostTicks = std::numeric_limits<TimeNs>::max() / kNsPerTick;
  return std::clamp(t.time_since_epoch().count() - kTicksFrom1601To1970, -kMostTicks, kMostTicks) * kNsPerTick;
}

mrpt::Clock::time_point toMrptTime(TimeNs t) {
  return mrpt::Clock::time_point(mrpt::Clock::duration(kTicksFrom1601To1970 + floorDiv(t, kNsPerTick)));
}

TimeNs durationNs(double seconds) { return static_cast<TimeNs>(std::llround(seconds * 1e9)); }

std::string formatUnixTime(TimeNs t) {
  const std::int64_t s = floorDiv(t, kNsPerSecond);
  char text[40];
  std::snprintf(text, sizeof text, "%lld.%09lld", static_cast<long long>(s),
                static_cast<long long>(t - s * kNsPerSecond));
  return text;
}

std::string formatUtc(TimeNs t) {
  const std::int64_t s = floorDiv(t, kNsPerSecond);
  char fraction[20];
  std::snprintf(fraction, sizeof fraction, ".%03lldZ", static_cast<long long>((t - s * kNsPerSecond) / 1'000'000));
  return dateText(static_cast<std::time_t>(s)) + fraction;
}

TimeNs parseTime(const std::string& text, const std::string& what) {
  TimeNs t = 0;
  if (parseUnixTime(text, t) || parseUtc(text, t)) return t;
  throw ConfigError("'" + text + "' is not a time", what,
                    "give Unix seconds (1733400000.25) or UTC as 2024-12-05T12:00:00.25Z");
}

std::string formatDuration(double seconds) {
  char text[40];
  if (seconds < 1)
    std::snprintf(text, sizeof text, "%.0f ms", 1e3 * seconds);
  else if (seconds < 60)
    std::snprintf(text, sizeof text, "%.1f s", seconds);
  else if (seconds < 3600)
    std::snprintf(text, sizeof text, "%d min %02d s", static_cast<int>(seconds) / 60, static_cast<int>(seconds) % 60);
  else
    std::snprintf(text, sizeof text, "%d h %02d min", static_cast<int>(seconds / 3600),
                  static_cast<int>(seconds / 60) % 60);
  return text;
}

}  // namespace s2s::core
