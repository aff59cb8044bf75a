#include "command_line.h"
#include "commands.h"

int main(int argc, char** argv) {
  CLI::App app(
      "Reads, optimises, converts and describes 3D pose graphs: g2o's .g2o and MRPT's .graph files.\n"
      "Exit status: 0 done, 2 wrong usage, 3 unusable input, 4 unwritable output.",
      "seabed-sky-graph");
  app.require_subcommand(1);
  std::function<int()> body;
  s2s::apps::addOptimizeCommand(app, body);
  s2s::apps::addInfoCommand(app, body);
  s2s::apps::addCompareCommand(app, body);
  return s2s::apps::run(app, argc, argv, [&] { return body(); });
}
