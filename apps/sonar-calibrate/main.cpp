#include <fstream>
#include <iostream>
#include <sstream>
#include <thread>

#include "command_line.h"
#include "s2s/calib/calibration_report.h"
#include "s2s/core/atomic_file.h"
#include "s2s/core/error.h"
#include "s2s/mapper/calibrate_survey.h"

namespace {

constexpr const char* kDescription =
    "Estimates the mountings and time offsets of both sonars and the sound speed from a survey, says what the survey\n"
    "could not tell, and writes a configuration with what it could.\n"
    "Example: sonar-calibrate survey.rawlog --config my-vessel.ini --output my-vessel-calibrated.ini\n"
    "How it works, and how to sail for it: share/docs/calibration.md";

std::string contentOf(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(kDescription, "sonar-calibrate");
  s2s::mapper::CalibrationRun run;
  run.threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  std::string config, output;
  std::vector<std::string> overrides;
  bool quiet = false;
  app.add_option("rawlog", run.rawlog, "Rawlog of the survey")->type_name("SURVEY.rawlog")->required();
  app.add_option("--config", config, "Configuration with the nominal mountings (INI)")->type_name("INI")->required();
  app.add_option("--output", output, "The calibrated configuration")->type_name("INI")->required();
  app.add_option("--from", run.from_s, "Start this many seconds after the first record")->check(CLI::NonNegativeNumber);
  app.add_option("--to", run.to_s, "End this many seconds after the first record")->check(CLI::NonNegativeNumber);
  app.add_option("--threads", run.threads, "1: one thread, the same result bit for bit")->check(CLI::PositiveNumber);
  app.add_option("--set", overrides, "Override a value of the configuration")->type_name("SECTION.KEY=VALUE");
  app.add_flag("--quiet", quiet, "No progress");

  return s2s::apps::run(app, argc, argv, [&] {
    const auto survey = s2s::mapper::loadSurveyConfig(config, overrides);
    if (!quiet) run.progress = &std::cerr;
    const auto calibration = s2s::mapper::calibrateSurvey(run, survey);
    s2s::core::writeTextFile(output, s2s::calib::calibratedIni(contentOf(config), calibration.result));
    std::cout << s2s::calib::reportText(calibration.result);
    for (const auto& warning : calibration.warnings) std::cout << "  warning: " << warning << '\n';
    std::cout << "\nWritten: " << output << '\n';
    return s2s::apps::kSuccess;
  });
}
