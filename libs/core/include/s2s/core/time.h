#pragma once

#include <mrpt/core/Clock.h>

#include <cstdint>
#include <string>

namespace s2s::core {

/// Nanoseconds since 1970-01-01 00:00 UTC. The one time type inside the program; differences are exact.
using TimeNs = std::int64_t;

constexpr TimeNs kNsPerSecond = 1'000'000'000;

/// Exact conversions to and from MRPT's 100 ns ticks since 1601 (`mrpt::Clock::toDouble` only resolves 238 ns today).
/// `toMrptTime` rounds down to a tick. Times outside the years 1678 to 2261, MRPT's invalid time among them, become the
/// nearest that fits.
TimeNs fromMrptTime(mrpt::Clock::time_point t);
mrpt::Clock::time_point toMrptTime(TimeNs t);

/// Difference `later - earlier` in seconds.
inline double secondsBetween(TimeNs earlier, TimeNs later) { return 1e-9 * static_cast<double>(later - earlier); }

/// A duration in seconds as nanoseconds, rounded to the nearest.
TimeNs durationNs(double seconds);

/// Unix time in seconds with all nine decimals, e.g. "1733400000.123456789".
std::string formatUnixTime(TimeNs t);

/// ISO 8601 in UTC with milliseconds, e.g. "2024-12-05T12:00:00.123Z".
std::string formatUtc(TimeNs t);

/// Reads "1733400000.123456789" or "2024-12-05T12:00:00.123Z"; `what` names the value in the error.
/// @throws ConfigError if the text is neither
TimeNs parseTime(const std::string& text, const std::string& what);

/// A duration for people: "850 ms", "12.3 s", "4 min 05 s", "2 h 03 min".
std::string formatDuration(double seconds);

}  // namespace s2s::core
