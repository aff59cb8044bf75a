// rawlog-merge: several rawlogs as one, in the order of time.

#include <iostream>

#include "command_line.h"
#include "common/converter_options.h"
#include "rawlog-merge/rawlog_merger.h"
#include "s2s/core/error.h"
#include "s2s/core/option_table.h"

namespace {

using s2s::core::ConfigError;

/// Splits "key=value" at the first equals sign.
std::pair<std::string, std::string> splitPair(const std::string& text, const char* option, const char* form) {
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    throw ConfigError("'" + text + "' is not of the form " + form, option, std::string("write ") + option + " " + form);
  return {text.substr(0, equals), text.substr(equals + 1)};
}

void addOffset(const std::string& text, s2s::tools::merge::MergeOptions& options) {
  const auto [number, seconds] = splitPair(text, "--offset", "N=SECONDS");
  int place = 0;
  double value = 0;
  if (!s2s::core::parseInt(number, place) || place < 1 || !s2s::core::parseDouble(seconds, value))
    throw ConfigError("'" + text + "' is no input number and seconds", "--offset", "write --offset 2=-0.25");
  options.offset_s[static_cast<std::size_t>(place - 1)] = value;
}

void addPose(const std::string& text, s2s::tools::merge::MergeOptions& options) {
  const auto [label, pose] = splitPair(text, "--pose", "\"LABEL=X Y Z YAW PITCH ROLL\"");
  if (!s2s::core::parsePose(pose, options.T_vehicle_sensor[label]))
    throw ConfigError("'" + pose + "' is not a pose", "--pose", "give six numbers: x y z yaw_deg pitch_deg roll_deg");
}

void addOptions(CLI::App& app, s2s::tools::merge::MergeOptions& options) {
  app.add_option("inputs", options.inputs, "rawlogs to merge")->required()->type_name("RAWLOG");
  app.add_option("--output", options.output, "rawlog to write")->required()->type_name("FILE");
  const auto each = [&app](const char* name, const char* help, const char* type, auto take) {
    app.add_option_function<std::vector<std::string>>(
           name,
           [take](const std::vector<std::string>& texts) {
             for (const auto& text : texts) take(text);
           },
           help)
        ->type_name(type)
        ->allow_extra_args(false);
  };
  each("--offset", "add seconds to all times of the Nth input (from 1); may be repeated", "N=SECONDS",
       [&options](const std::string& text) { addOffset(text, options); });
  each("--label", "give a sensor another label; may be repeated", "OLD=NEW",
       [&options](const std::string& text) { options.newLabel.insert(splitPair(text, "--label", "OLD=NEW")); });
  each("--pose", "give a sensor another pose on the vehicle, in metres and degrees; may be repeated",
       "\"LABEL=X Y Z YAW PITCH ROLL\"", [&options](const std::string& text) { addPose(text, options); });
  app.add_option("--window", options.reorderWindow_s, "sort records that are out of order by up to this, in seconds")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str()
      ->type_name("S");
  app.add_option("--gz", options.gzLevel, "compress with zlib level 1 to 9 (reading costs 25 times as much)")
      ->check(CLI::Range(0, 9))
      ->type_name("LEVEL")
      ->default_str("0, not compressed");
}

}  // namespace

int main(int argc, char** argv) {
  using namespace s2s;
  CLI::App app("Merges rawlogs by time, each with an offset if its clock was apart.", "rawlog-merge");
  app.footer("Example:\n  rawlog-merge lidar.rawlog sonar.rawlog --offset 2=-0.25 --output survey.rawlog");
  tools::merge::MergeOptions options;
  addOptions(app, options);
  return apps::run(app, argc, argv, [&] {
    tools::printReport(tools::merge::mergeRawlogs(options, &std::cerr), options.output);
    return apps::kSuccess;
  });
}
