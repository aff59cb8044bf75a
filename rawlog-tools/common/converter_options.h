#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "common/conversion_report.h"
#include "s2s/core/time.h"
#include "s2s/core/transform.h"

namespace s2s::tools {

/// What all converters take.
struct ConverterOptions {
  std::string output;  ///< the rawlog to write
  std::string label;   ///< sensor label of the observations
  core::Isometry T_vehicle_sensor = core::Isometry::Identity();
  std::optional<core::TimeNs> startTime;  ///< time of the first observation, where the data carry no wall clock
  int gzLevel = 0;                        ///< 0: not compressed
};

/// Time of the first observation when neither the data nor the user give one: 2000-01-01T00:00:00Z.
constexpr core::TimeNs kDefaultStartTime = 946'684'800 * core::kNsPerSecond;

void addOutputOptions(CLI::App& app, ConverterOptions& options);
/// `--label`, with the value that is in `options.label` as default, and `--pose`.
void addSensorOptions(CLI::App& app, ConverterOptions& options);
/// `--start-time`; `otherwise` says what holds without it.
void addStartTimeOption(CLI::App& app, ConverterOptions& options, const std::string& otherwise);

/// Prints what a conversion did, to stdout.
void printReport(const ConversionReport& report, const std::string& output);

}  // namespace s2s::tools
