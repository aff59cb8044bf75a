#include <gtest/gtest.h>

#include "s2s/core/error.h"
#include "s2s/sonar/options_table.h"

namespace s2s::sonar {
namespace {

TEST(SonarOptionsTable, PrintedOptions_ReadBackTheSame) {
  SonarOptions options;
  options.horizontal.preprocess.steps = {PreprocessStep::Median, PreprocessStep::Normalise};
  options.horizontal.leadingEdge.threshold = 61;
  options.vertical.cfar.kind = CfarKind::OrderedStatistic;
  options.vertical.features.maxRunWidth_rad = 0.05;
  options.stereo.dbscan.epsilon_m = 0.33;
  options.stereo.clusters.pairing = ClusterPairing::Both;
  options.stereo.matching.assignment.optimalEdges = 17;
  options.stereo.triangulation.fusion = Fusion::Coordinate;
  const std::string text = printSonars(options);
  auto ini = core::IniFile::parse(text, "printed");
  SonarOptions read;
  loadSonars(ini, read);
  ini.rejectUnread();
  EXPECT_EQ(printSonars(read), text);
  EXPECT_NE(printSonars(SonarOptions{}), text);
}

TEST(SonarOptionsTable, Defaults_AreThePapersValues) {
  const SonarOptions o;
  EXPECT_EQ(o.horizontal.leadingEdge.threshold, 80);
  EXPECT_EQ(o.vertical.leadingEdge.threshold, 130);
  EXPECT_EQ(o.horizontal.cfar.referenceCells, 16);
  EXPECT_EQ(o.vertical.cfar.referenceCells, 24);
  for (const auto& cfar : {o.horizontal.cfar, o.vertical.cfar}) {
    EXPECT_EQ(cfar.kind, CfarKind::SmallestOf);
    EXPECT_EQ(cfar.guardCells, 8);
    EXPECT_EQ(cfar.falseAlarmProbability, 0.2);
  }
  EXPECT_EQ(o.horizontal.cfar.minIntensity, 100);
  EXPECT_EQ(o.vertical.cfar.minIntensity, 130);
  EXPECT_EQ(o.stereo.dbscan.epsilon_m, 0.20);
  EXPECT_EQ(o.stereo.dbscan.minPoints, 20);
}

TEST(SonarOptionsTable, Steps_AreReadInOrder) {
  auto ini = core::IniFile::parse("[sonar.vertical.preprocess]\nsteps = otsu_mask row_mean\n", "test");
  SonarOptions options;
  loadSonars(ini, options);
  EXPECT_EQ(options.vertical.preprocess.steps,
            (std::vector<PreprocessStep>{PreprocessStep::OtsuMask, PreprocessStep::RowMean}));
  auto none = core::IniFile::parse("[sonar.vertical.preprocess]\nsteps = none\n", "test");
  loadSonars(none, options);
  EXPECT_TRUE(options.vertical.preprocess.steps.empty());
}

TEST(SonarOptionsTable, WrongValuesAndKeys_AreRefusedWithTheirPlace) {
  SonarOptions options;
  auto step = core::IniFile::parse("[sonar.horizontal.preprocess]\nsteps = otsu_musk\n", "test.ini");
  try {
    loadSonars(step, options);
    FAIL() << "accepted";
  } catch (const core::ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find("otsu_mask"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("test.ini:2"), std::string::npos) << e.what();
  }
  auto key = core::IniFile::parse("[sonar.stereo.dbscan]\nepsilon = 0.2\n", "test.ini");
  loadSonars(key, options);
  EXPECT_THROW(key.rejectUnread(), core::ConfigError);
  auto range = core::IniFile::parse("[sonar.horizontal.cfar]\nfalse_alarm_probability = 1.5\n", "test.ini");
  EXPECT_THROW(loadSonars(range, options), core::ConfigError);
}

}  // namespace
}  // namespace s2s::sonar
