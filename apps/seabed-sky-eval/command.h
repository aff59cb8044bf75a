#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

namespace s2s::apps {

/// A subcommand: it declares its options when made and runs when the user chose it.
class Command {
 public:
  virtual ~Command() = default;

  bool chosen() const { return parser_->parsed(); }
  /// Prints the report and writes the JSON file if one was asked for.
  /// @throws core::Error
  virtual void run() = 0;

 protected:
  Command(CLI::App& app, const std::string& name, const std::string& description);

  CLI::App& parser() { return *parser_; }
  void finish(const std::string& text, const nlohmann::ordered_json& json) const;

 private:
  CLI::App* parser_;
  std::string jsonFile_;
};

std::unique_ptr<Command> makeTruthCommand(CLI::App& app);
std::unique_ptr<Command> makeControlCommand(CLI::App& app);
std::unique_ptr<Command> makeWallCommand(CLI::App& app);
std::unique_ptr<Command> makePickCommand(CLI::App& app);
std::unique_ptr<Command> makeQualityCommand(CLI::App& app);

}  // namespace s2s::apps
