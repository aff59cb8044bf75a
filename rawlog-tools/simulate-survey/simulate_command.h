#pragma once

#include <CLI/CLI.hpp>
#include <iosfwd>
#include <string>
#include <vector>

#include "s2s/sim/survey_simulator.h"

namespace s2s::tools {

/// The command line of simulate-survey and what it does.
class SimulateCommand {
 public:
  void addOptions(CLI::App& app);
  /// Simulates and writes everything; a table of what was made goes to `out`, progress to `log`.
  /// @returns the program's exit code
  /// @throws core::Error
  int run(std::ostream& out, std::ostream& log);

 private:
  void applyCommandLine(sim::SimulationOptions& options) const;
  sim::SimulationSummary record(const sim::SurveySimulator& simulator, const sim::SimulationOptions& options,
                                std::ostream& log) const;

  std::string scenePath_, output_, lidar_;
  std::vector<std::string> settings_;
  int experiment_ = 1, gzLevel_ = 0, threads_ = 0;
  std::uint64_t seed_ = 1;
  double duration_s_ = 0;
  bool listOptions_ = false;
};

}  // namespace s2s::tools
