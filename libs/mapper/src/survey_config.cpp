#include "s2s/mapper/survey_config.h"

#include "s2s/calib/options_table.h"
#include "s2s/core/error.h"
#include "s2s/core/ini_file.h"
#include "s2s/graph/options_table.h"
#include "s2s/map/options_table.h"
#include "s2s/odometry/options_table.h"
#include "s2s/products/options_table.h"

namespace s2s::mapper {

namespace {

using Sections = std::vector<std::pair<std::string, core::OptionTable>>;

/// Every section but the sonars', which come with functions of their own.
Sections sectionsOf(SurveyConfig& config) {
  Sections sections = {{"mapper", optionTable(config.mapper)},
                       {"mapper.gnss", optionTable(config.mapper.gnssReader)},
                       {"odometry", odometry::optionTable(config.odometry)},
                       {"map", map::optionTable(config.map.insertion)},
                       {"map.resolver", map::optionTable(config.map.resolver)},
                       {"map.likelihood", map::optionTable(config.map.likelihood)},
                       {"map.view", map::optionTable(config.map.view)},
                       {"products", products::optionTable(config.products)},
                       {"calibration", calib::optionTable(config.calibration)},
                       {"calibration.aperture", calib::optionTable(config.calibration.aperture)},
                       {"calibration.mirror", calib::optionTable(config.calibration.mirror)},
                       {"calibration.texture", calib::optionTable(config.calibration.texture)},
                       {"calibration.swath", calib::optionTable(config.swath)}};
  for (auto& section : graph::optionSections(config.graph)) sections.push_back(std::move(section));
  return sections;
}

void applyOverride(core::IniFile& ini, const std::string& text) {
  const auto equals = text.find('=');
  const auto dot = equals == std::string::npos ? std::string::npos : text.rfind('.', equals);
  if (dot == std::string::npos || dot == 0 || dot + 1 == equals)
    throw core::ConfigError("'" + text + "' sets nothing", "--set", "write --set section.key=value");
  ini.set(text.substr(0, dot), text.substr(dot + 1, equals - dot - 1), text.substr(equals + 1));
}

}  // namespace

SurveyConfig loadSurveyConfig(const std::string& path, const std::vector<std::string>& overrides) {
  auto ini = path.empty() ? core::IniFile::parse("", "defaults") : core::IniFile::load(path);
  for (const auto& text : overrides) applyOverride(ini, text);
  SurveyConfig config;
  for (auto& [name, table] : sectionsOf(config)) table.load(ini, name);
  sonar::loadSonars(ini, config.sonar);
  ini.rejectUnread();
  config.map.surface = config.products.grid;  // the cells of seabed and walls are set where the products are
  config.map.walls = config.products.wallSurface;
  config.map.waterline_m = config.mapper.waterline_m;
  return config;
}

std::string printSurveyConfig(const SurveyConfig& config) {
  SurveyConfig copy = config;  // the tables bind to variables
  std::string text;
  for (const auto& [name, table] : sectionsOf(copy)) text += table.print(name) + "\n";
  return text + sonar::printSonars(copy.sonar);
}

}  // namespace s2s::mapper
