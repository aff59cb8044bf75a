#include <iostream>

#include "command_line.h"
#include "inspector.h"
#include "s2s/core/ini_file.h"

int main(int argc, char** argv) {
  CLI::App app(
      "Draws every stage of the sonar chain for one ping (and the partner ping of the other sonar) as PNG files",
      "sonar-inspect");
  std::string rawlog, folder, config;
  std::size_t ping = 0;
  s2s::inspect::PingLabels labels;
  app.add_option("rawlog", rawlog, "Log with pings of one or two imaging sonars")->required();
  app.add_option("--ping", ping, "Number of the ping, from 0")->capture_default_str();
  app.add_option("--output", folder, "Folder for the pictures; made when missing")->required();
  app.add_option("--config", config, "INI with sections [sonar.horizontal...], [sonar.vertical...], [sonar.stereo...]");
  app.add_option("--horizontal-label", labels.horizontal, "Sensor label of the horizontal sonar")
      ->capture_default_str();
  app.add_option("--vertical-label", labels.vertical, "Sensor label of the vertical sonar")->capture_default_str();

  return s2s::apps::run(app, argc, argv, [&] {
    s2s::sonar::SonarOptions options;
    if (!config.empty()) {
      auto ini = s2s::core::IniFile::load(config);
      s2s::sonar::loadSonars(ini, options);
      ini.rejectUnread("sonar");  // a vessel's configuration has other sections, too
    }
    s2s::inspect::Inspector inspector(options, folder);
    std::cout << inspector.inspect(s2s::inspect::readPings(rawlog, labels, ping));
    std::cout << inspector.pictureCount() << " pictures in " << folder << '\n';
    return s2s::apps::kSuccess;
  });
}
