#include <iostream>
#include <thread>

#include "closing_table.h"
#include "command_line.h"
#include "s2s/mapper/run_survey.h"

namespace {

constexpr const char* kDescription =
    "Turns the rawlog of a survey into one map from the seabed to the sky.\n"
    "Example: seabed-sky-map out/sim/survey.rawlog --config out/sim/survey.ini --output out/map\n"
    "Every option of the configuration, with its default and meaning: seabed-sky-map --print-config";

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(kDescription, "seabed-sky-map");
  s2s::mapper::SurveyRun run;
  run.threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  std::string config;
  std::vector<std::string> overrides;
  bool printConfig = false, quiet = false;

  app.add_option("rawlog", run.rawlog, "Rawlog of the survey")->type_name("SURVEY.rawlog");
  app.add_option("--config", config, "Configuration of vessel and processing (INI)")->type_name("INI");
  app.add_option("--output", run.output, "Folder for the products; made when missing")->type_name("DIR");
  app.add_option("--from", run.from_s, "Start this many seconds after the first record")->check(CLI::NonNegativeNumber);
  app.add_option("--to", run.to_s, "End this many seconds after the first record")->check(CLI::NonNegativeNumber);
  app.add_option("--threads", run.threads, "1: one thread, the same map bit for bit; more: a thread for each stage")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--map", run.priorMap, "Start in the map of an earlier run (its output folder), without GNSS")
      ->type_name("PRIOR");
  app.add_flag("--realtime", run.realtime,
               "Replay at the recorded rate: report latencies, and drop sweeps and pings that cannot wait");
  app.add_option("--set", overrides, "Override a value of the configuration")->type_name("SECTION.KEY=VALUE");
  app.add_flag("--print-config", printConfig, "Print the configuration that would be used and stop");
  app.add_flag("--quiet", quiet, "No progress and no closing table");

  return s2s::apps::run(app, argc, argv, [&] {
    const auto survey = s2s::mapper::loadSurveyConfig(config, overrides);
    if (printConfig) {
      std::cout << s2s::mapper::printSurveyConfig(survey);
      return s2s::apps::kSuccess;
    }
    s2s::apps::requireMapArguments(run, config);
    if (!quiet) run.progress = &std::cerr;
    const auto summary = s2s::mapper::runSurvey(run, survey);
    if (!quiet) std::cout << s2s::apps::closingTable(summary, run.output);
    return s2s::apps::kSuccess;
  });
}
