#include "simulate_command.h"

#include <tbb/global_control.h>

#include <chrono>
#include <filesystem>
#include <iomanip>
#include <ostream>
#include <thread>

#include "s2s/core/atomic_file.h"
#include "s2s/core/error.h"
#include "s2s/core/progress.h"
#include "s2s/obs/rawlog_writer.h"
#include "s2s/sim/options_table.h"
#include "s2s/sim/scene_loader.h"
#include "s2s/sim/truth_writer.h"

namespace s2s::tools {

namespace {

/// "section.key=value" into the INI; sections may have dots, keys have none.
void applySetting(core::IniFile& ini, const std::string& setting) {
  const std::size_t equals = setting.find('=');
  const std::size_t dot = equals == std::string::npos ? equals : setting.rfind('.', equals);
  if (dot == std::string::npos)
    throw core::ConfigError("'" + setting + "' is no setting", "--set", "write section.key=value");
  ini.set(setting.substr(0, dot), setting.substr(dot + 1, equals - dot - 1), setting.substr(equals + 1));
}

void printSummary(std::ostream& out, const sim::SimulationSummary& s, double wall_s) {
  const auto row = [&out](const char* name, const auto& value, const char* unit) {
    out << "  " << std::left << std::setw(18) << name << std::right << std::setw(12) << value << " " << unit << '\n';
  };
  out << std::fixed << std::setprecision(1);
  row("survey", s.duration_s, "s");
  row("path", s.length_m, "m");
  row("sweeps", s.sweeps, "");
  row("pings horizontal", s.pingsHorizontal, "");
  row("pings vertical", s.pingsVertical, "");
  row("IMU samples", s.imuSamples, "");
  row("GNSS fixes", s.fixes, "");
  row("simulated in", wall_s, "s");
  row("rate", s.duration_s / std::max(wall_s, 1e-9), "x real time");
}

}  // namespace

void SimulateCommand::addOptions(CLI::App& app) {
  app.add_option("--scene", scenePath_, "INI file of the scene, e.g. share/scenes/canal.ini")->required();
  app.add_option("--experiment", experiment_, "number of the experiment in the scene")->capture_default_str();
  app.add_option("--output", output_, "folder for survey.rawlog, survey.ini and truth/; made when missing");
  app.add_option("--duration", duration_s_, "end after this many seconds (default: the whole experiment)")
      ->check(CLI::PositiveNumber);
  app.add_option("--seed", seed_, "seed of all noise; the same seed gives the same bytes")->capture_default_str();
  app.add_option("--lidar", lidar_, "LiDAR mode ROWSxCOLUMNS@HZ, e.g. 64x1024@10 or 128x1024@20");
  app.add_option("--set", settings_,
                 "SECTION.KEY=VALUE instead of the scene's value; may be repeated, e.g.\n"
                 "--set sonar.horizontal.speckle=false");
  app.add_option("--gz", gzLevel_, "compress the rawlog with this level; 0 writes faster and reads 25 times as fast")
      ->check(CLI::Range(0, 9))
      ->capture_default_str();
  app.add_option("--threads", threads_, "number of threads; 0: one a core. The bytes do not depend on it")
      ->check(CLI::Range(0, 1024));
  app.add_flag("--list-options", listOptions_, "print all settings with their values in this scene, and end");
  app.footer(
      "The scene's INI describes the world (objects, materials, seabed), the experiments (waypoints, speed) and\n"
      "the simulation: vessel, waves, lidar, imu, sonar.horizontal, sonar.vertical, gnss, mounting, faults. Every\n"
      "physical effect has a key and can be switched off alone; --list-options shows all, share/docs/simulation.md\n"
      "explains each with its equation.\n\n"
      "Example: simulate-survey --scene share/scenes/canal.ini --experiment 1 --output out/sim --duration 90");
}

void SimulateCommand::applyCommandLine(sim::SimulationOptions& options) const {
  options.seed = seed_;
  options.duration_s = duration_s_;
  if (!lidar_.empty()) sim::parseLidarMode(lidar_, options.lidar);
}

sim::SimulationSummary SimulateCommand::record(const sim::SurveySimulator& simulator,
                                               const sim::SimulationOptions& options, std::ostream& log) const {
  obs::RawlogWriterOptions writerOptions;
  writerOptions.gzLevel = gzLevel_;
  writerOptions.sorted = !options.faults.clockJumps();
  const std::string rawlog = output_ + "/survey.rawlog";
  obs::RawlogWriter writer(rawlog, writerOptions);
  sim::PingTruthWriter horizontal(output_ + "/truth/returns_" + options.sonarHorizontal.label + ".bin");
  sim::PingTruthWriter vertical(output_ + "/truth/returns_" + options.sonarVertical.label + ".bin");
  core::Progress progress(&log, "simulating", simulator.duration_s(), "s");
  sim::SimulationSinks sinks;
  sinks.record = [&](const auto& observation) { writer.write(observation); };
  sinks.returnsHorizontal = [&](const sim::PingTruth& truth) { horizontal.write(truth); };
  sinks.returnsVertical = [&](const sim::PingTruth& truth) { vertical.write(truth); };
  sinks.progress = [&](double t_s) { progress.update(t_s); };
  const sim::SimulationSummary summary = simulator.run(sinks);
  writer.close();
  horizontal.close();
  vertical.close();
  progress.finish();
  if (options.faults.cutBytes > 0) {
    const auto size = std::filesystem::file_size(rawlog);
    std::filesystem::resize_file(rawlog, size - std::min<std::uintmax_t>(size, options.faults.cutBytes));
  }
  return summary;
}

int SimulateCommand::run(std::ostream& out, std::ostream& log) {
  core::IniFile ini = core::IniFile::load(scenePath_);
  for (const std::string& setting : settings_) applySetting(ini, setting);
  sim::SimulationOptions options;
  sim::loadSimulationOptions(ini, options);
  const sim::Scene scene = sim::loadScene(ini);
  ini.rejectUnread();
  applyCommandLine(options);
  if (listOptions_) {
    out << sim::printSimulationOptions(options);
    return 0;
  }
  if (output_.empty()) throw core::ConfigError("no output folder is given", "--output", "name the folder to write to");

  tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                              threads_ > 0 ? static_cast<std::size_t>(threads_) : std::thread::hardware_concurrency());
  const sim::SurveySimulator simulator(scene, experiment_, options);
  log << "scene '" << scene.name << "', experiment " << experiment_ << ": " << scene.experiment(experiment_).description
      << '\n';
  sim::writeTruth(output_ + "/truth", scene, options, simulator.motion(), simulator.duration_s());
  sim::writeSurveyIni(output_ + "/survey.ini", scene, options);
  core::writeTextFile(output_ + "/simulation.ini", sim::printSimulationOptions(options));

  const auto start = std::chrono::steady_clock::now();
  const sim::SimulationSummary summary = record(simulator, options, log);
  printSummary(out, summary, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  return 0;
}

}  // namespace s2s::tools
