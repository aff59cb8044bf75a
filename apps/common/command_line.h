#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace s2s::apps {

/// Exit codes of all programs.
enum ExitCode : int {
  kSuccess = 0,
  kInternalError = 1,  ///< a fault of the program
  kUsageError = 2,     ///< wrong command line or configuration
  kUnusableInput = 3,  ///< input that cannot be read or used
  kUnwritableOutput = 4
};

/// Parses the command line and runs `body`; every error becomes a message on stderr and an exit code. With `--help`
/// and `--version` the text goes to stdout and `body` is not run.
int run(CLI::App& app, int argc, char** argv, const std::function<int()>& body);

}  // namespace s2s::apps
