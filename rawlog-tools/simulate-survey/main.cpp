#include <iostream>

#include "command_line.h"
#include "simulate_command.h"

int main(int argc, char** argv) {
  CLI::App app("Simulates a survey: LiDAR, IMU, two imaging sonars and GNSS of a vessel in a scene, with the truth.",
               "simulate-survey");
  s2s::tools::SimulateCommand command;
  command.addOptions(app);
  return s2s::apps::run(app, argc, argv, [&] { return command.run(std::cout, std::cerr); });
}
