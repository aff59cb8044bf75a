#include "common/converter_options.h"

#include <iostream>

#include "s2s/core/error.h"
#include "s2s/core/option_table.h"

namespace s2s::tools {

void addOutputOptions(CLI::App& app, ConverterOptions& options) {
  app.add_option("--output", options.output, "rawlog to write")->required()->type_name("FILE");
  app.add_option("--gz", options.gzLevel, "compress with zlib level 1 to 9 (reading costs 25 times as much)")
      ->check(CLI::Range(0, 9))
      ->type_name("LEVEL")
      ->default_str("0, not compressed");
}

void addSensorOptions(CLI::App& app, ConverterOptions& options) {
  app.add_option("--label", options.label, "sensor label of the observations")
      ->capture_default_str()
      ->type_name("TEXT");
  app.add_option_function<std::string>(
         "--pose",
         [&options](const std::string& text) {
           if (!core::parsePose(text, options.T_vehicle_sensor))
             throw core::ConfigError("'" + text + "' is not a pose", "--pose",
                                     "give six numbers in quotes: \"x y z yaw_deg pitch_deg roll_deg\"");
         },
         "pose of the sensor on the vehicle (x forward, y left, z up) in metres and degrees")
      ->type_name("\"X Y Z YAW PITCH ROLL\"")
      ->default_str("0 0 0 0 0 0");
}

void addStartTimeOption(CLI::App& app, ConverterOptions& options, const std::string& otherwise) {
  app.add_option_function<std::string>(
         "--start-time",
         [&options](const std::string& text) { options.startTime = core::parseTime(text, "--start-time"); },
         "time of the first observation: Unix seconds or UTC as 2024-12-05T12:00:00Z; otherwise " + otherwise)
      ->type_name("TIME");
}

void printReport(const ConversionReport& report, const std::string& output) {
  std::cout << report.text() << "wrote    " << output << '\n';
}

}  // namespace s2s::tools
