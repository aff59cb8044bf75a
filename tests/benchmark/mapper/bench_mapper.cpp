// The whole of seabed-sky-map, products included, beside the cost of only reading the same rawlog, as ratios in one
// run.
#include <mrpt/core/format.h>
#include <sys/resource.h>

#include <chrono>
#include <iostream>
#include <thread>

#include "command_line.h"
#include "s2s/mapper/run_survey.h"
#include "s2s/obs/rawlog_reader.h"

namespace {

/// Wall and processor time of some work. On a machine with other work, only the latter tells what it costs.
struct Cost {
  double wall_s = 0, processor_s = 0;
};

double processorTime_s() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * t.tv_usec; };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

template <class Work>
Cost measure(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  const double before_s = processorTime_s();
  work();
  return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
          processorTime_s() - before_s};
}

void readAll(const std::string& rawlog) {
  s2s::obs::RawlogReader reader(rawlog);
  while (reader.next()) {
  }
}

void printCost(const std::string& name, const Cost& cost, double survey_s, const Cost& reading) {
  std::cout << mrpt::format("%-36s %8.2f s %6.2f x real time %8.2f s %8.1f x reading\n", name.c_str(), cost.wall_s,
                            survey_s / cost.wall_s, cost.processor_s, cost.processor_s / reading.processor_s);
}

void printStages(const s2s::products::RunSummary& summary) {
  std::cout << "\nwhere the time goes (wall time of each stage; threads run side by side)\n";
  for (const auto& [name, time_s] : summary.stageTimes_s)
    std::cout << mrpt::format("  %-34s %8.2f s %6.1f %% of the survey's length\n", name.c_str(), time_s,
                              100 * time_s / summary.duration_s);
}

/// The same vessel without its sonars: what they cost is the difference.
s2s::mapper::SurveyConfig withoutSonars(s2s::mapper::SurveyConfig config) {
  config.mapper.sonarHorizontal.label = "no horizontal sonar";
  config.mapper.sonarVertical.label = "no vertical sonar";
  return config;
}

void printSonarShare(const Cost& with, const Cost& without, double survey_s) {
  std::cout << mrpt::format("the sonars' share: %.1f %% of one core at the recorded rate, products included\n",
                            100 * (with.processor_s - without.processor_s) / survey_s);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Maps a survey and reads it only, and compares the costs.", "bench_mapper");
  std::string survey;
  s2s::mapper::SurveyRun run;
  run.threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  app.add_option("survey", survey, "Folder of a simulated survey")->required();
  app.add_option("--output", run.output, "Folder for the products")->required();
  app.add_option("--threads", run.threads, "Threads of the mapper")->check(CLI::PositiveNumber);
  return s2s::apps::run(app, argc, argv, [&] {
    run.rawlog = survey + "/survey.rawlog";
    const auto config = s2s::mapper::loadSurveyConfig(survey + "/survey.ini");
    readAll(run.rawlog);  // so that both find the file in memory
    const Cost reading = measure([&] { readAll(run.rawlog); });
    s2s::products::RunSummary summary;
    const Cost mapping = measure([&] { summary = s2s::mapper::runSurvey(run, config); });
    std::cout << mrpt::format(
        "%.1f s of survey, %llu sweeps, %llu + %llu pings, peak memory %.0f MB\n\n%-36s %29s %10s\n",
        summary.duration_s, static_cast<unsigned long long>(summary.sweeps),
        static_cast<unsigned long long>(summary.pingsHorizontal),
        static_cast<unsigned long long>(summary.pingsVertical), summary.peakRss_mb, "", "wall time", "processor");
    printCost("reading only", reading, summary.duration_s, reading);
    printCost("mapping with all products", mapping, summary.duration_s, reading);
    auto lidarOnly = run;
    lidarOnly.output += "-without-sonars";
    const Cost without = measure([&] { s2s::mapper::runSurvey(lidarOnly, withoutSonars(config)); });
    printCost("the same without the sonars", without, summary.duration_s, reading);
    printSonarShare(mapping, without, summary.duration_s);
    printStages(summary);
    return s2s::apps::kSuccess;
  });
}
