#include "command.h"

#include <iostream>

#include "s2s/core/atomic_file.h"

namespace s2s::apps {

Command::Command(CLI::App& app, const std::string& name, const std::string& description)
    : parser_(app.add_subcommand(name, description)) {
  parser_->add_option("--json", jsonFile_, "Also write the report to this file")->type_name("FILE");
}

void Command::finish(const std::string& text, const nlohmann::ordered_json& json) const {
  std::cout << text;
  if (!jsonFile_.empty()) core::writeTextFile(jsonFile_, json.dump(2) + '\n');
}

}  // namespace s2s::apps
