#pragma once

#include <functional>
#include <string>

#include "s2s/core/ini_file.h"
#include "s2s/map/options_table.h"

namespace s2s::map {

/// Calls `visit(suffix, table)` for each part of the options; the suffixes are those of MRPT's map definitions.
inline void forEachSection(MapOptions& options,
                           const std::function<void(const std::string&, core::OptionTable)>& visit) {
  visit("insertOpts", optionTable(options.insertion));
  visit("resolverOpts", optionTable(options.resolver));
  visit("likelihoodOpts", optionTable(options.likelihood));
  visit("viewOpts", optionTable(options.view));
}

/// All options as INI text, and back; keys that the text lacks keep their defaults.
inline std::string optionsToText(MapOptions options) {
  std::string text;
  forEachSection(options, [&text](const std::string& section, const core::OptionTable& table) {
    text += table.print(section) + "\n";
  });
  return text;
}

inline MapOptions optionsFromText(const std::string& text) {
  MapOptions options;
  auto ini = core::IniFile::parse(text, "options of the map");
  forEachSection(options, [&ini](const std::string& section, core::OptionTable table) { table.load(ini, section); });
  return options;
}

}  // namespace s2s::map
