#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace s2s::apps {

/// Adds one subcommand each; when it is chosen, `body` is set to what it does.
void addOptimizeCommand(CLI::App& app, std::function<int()>& body);
void addInfoCommand(CLI::App& app, std::function<int()>& body);
void addCompareCommand(CLI::App& app, std::function<int()>& body);

}  // namespace s2s::apps
