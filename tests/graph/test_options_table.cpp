#include <gtest/gtest.h>

#include "s2s/core/error.h"
#include "s2s/graph/options_table.h"

using namespace s2s;
using namespace s2s::graph;

TEST(GraphOptionsTable, PrintedAndRead_IsTheSame) {
  GraphSlamOptions options;
  options.loops.radius_m = 17.25;
  options.keyframes.rotation_rad = 0.1;
  options.gnss.enabled = true;
  std::string text;
  for (const auto& [section, table] : optionSections(options)) text += table.print(section) + "\n";
  core::IniFile ini = core::IniFile::parse(text, "test");
  GraphSlamOptions read;
  for (auto& [section, table] : optionSections(read)) table.load(ini, section);
  EXPECT_NO_THROW(ini.rejectUnread());
  EXPECT_EQ(read.loops.radius_m, 17.25);
  EXPECT_NEAR(read.keyframes.rotation_rad, 0.1, 2e-11);  // degrees to nine decimals in the file
  EXPECT_TRUE(read.gnss.enabled);
}

TEST(GraphOptionsTable, ValueOutOfRange_NamesSectionAndKey) {
  GraphSlamOptions options;
  core::IniFile ini = core::IniFile::parse("[graph.registration]\nmin_overlap = 1.5\n", "test");
  try {
    for (auto& [section, table] : optionSections(options)) table.load(ini, section);
    FAIL();
  } catch (const core::ConfigError& e) {
    EXPECT_NE(e.where().find("graph.registration"), std::string::npos);
    EXPECT_NE(e.where().find("min_overlap"), std::string::npos);
  }
}
