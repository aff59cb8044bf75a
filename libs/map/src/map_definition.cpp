// How MRPT's programs create a CSeabedSkyMap from an INI file: seabedSkyMap_count = 1 and sections
// <prefix>_seabedSkyMap_00_{creationOpts,insertOpts,resolverOpts,likelihoodOpts,viewOpts}.

#include <mrpt/config/CConfigFileBase.h>

#include <algorithm>
#include <ostream>

#include "option_sections.h"
#include "s2s/core/error.h"
#include "s2s/map/CSeabedSkyMap.h"

namespace s2s::map {

namespace {

/// A section of MRPT's configuration through our strict reader, which refuses unknown keys and half-read numbers.
void loadStrictly(const mrpt::config::CConfigFileBase& source, const std::string& section, core::OptionTable& table) {
  std::vector<std::string> names;
  source.getAllKeys(section, names);
  std::string text = "[" + section + "]\n";
  for (const std::string& name : names) text += name + " = " + source.read_string(section, name, "") + "\n";
  auto ini = core::IniFile::parse(text, "map definition");
  table.load(ini, section);
  ini.rejectUnread();
}

}  // namespace

CSeabedSkyMap::TMapDefinition::TMapDefinition() = default;

void CSeabedSkyMap::TMapDefinition::loadFromConfigFile_map_specific(const mrpt::config::CConfigFileBase& source,
                                                                    const std::string& sectionNamePrefix) {
  forEachSection(options, [&](const std::string& suffix, core::OptionTable table) {
    loadStrictly(source, sectionNamePrefix + "_" + suffix, table);
  });
}

void CSeabedSkyMap::TMapDefinition::dumpToTextStream_map_specific(std::ostream& out) const {
  out << optionsToText(options);
}

mrpt::maps::CMetricMap* CSeabedSkyMap::internal_CreateFromMapDefinition(
    const mrpt::maps::TMetricMapInitializer& definition) {
  const auto* ours = dynamic_cast<const TMapDefinition*>(&definition);
  if (!ours)
    throw core::ConfigError("the definition is not one of a CSeabedSkyMap", "map definition",
                            "take CSeabedSkyMap::MapDefinition()");
  return new CSeabedSkyMap(ours->options);
}

}  // namespace s2s::map
