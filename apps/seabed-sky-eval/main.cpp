#include "command.h"
#include "command_line.h"

using namespace s2s::apps;

int main(int argc, char** argv) {
  CLI::App app("Measures how good a map of seabed-sky-map is", "seabed-sky-eval");
  app.require_subcommand(1);
  const auto commands = {makeTruthCommand(app), makeControlCommand(app), makeWallCommand(app), makePickCommand(app),
                         makeQualityCommand(app)};
  return run(app, argc, argv, [&] {
    for (const auto& command : commands)
      if (command->chosen()) command->run();
    return kSuccess;
  });
}
