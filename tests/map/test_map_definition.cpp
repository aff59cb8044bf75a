#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/maps/CMultiMetricMap.h>

#include "s2s/map/CSeabedSkyMap.h"
#include "s2s/map/options_table.h"
#include "s2s/map/register_classes.h"

namespace {

using namespace s2s::map;

CSeabedSkyMap::Ptr created(const std::string& text) {
  registerClasses();
  const mrpt::config::CConfigFileMemory ini(text);
  mrpt::maps::TSetOfMetricMapInitializers definition;
  definition.loadFromConfigFile(ini, "map");
  mrpt::maps::CMultiMetricMap maps;
  maps.setListOfMaps(definition);
  return maps.maps.empty() ? nullptr : std::dynamic_pointer_cast<CSeabedSkyMap>(maps.maps.at(0));
}

TEST(MapDefinition, AllNames_CreateTheMap) {
  for (const char* name : {"seabedSkyMap", "s2s::map::CSeabedSkyMap"})
    EXPECT_TRUE(created("[map]\n" + std::string(name) + "_count = 1\n")) << name;
}

TEST(MapDefinition, Options_ArriveInTheMap) {
  const auto map = created(
      "[map]\nseabedSkyMap_count = 1\n"
      "[map_seabedSkyMap_00_creationOpts]\nenableObservationLikelihood = false\n"
      "[map_seabedSkyMap_00_insertOpts]\ninterpolation = constant_velocity\nlidar_voxel_m = 0.3 // metres\n"
      "[map_seabedSkyMap_00_resolverOpts]\ngate = 4\n"
      "[map_seabedSkyMap_00_likelihoodOpts]\nsigma_m = 0.5\n"
      "[map_seabedSkyMap_00_viewOpts]\nmax_points = 77\n");
  ASSERT_TRUE(map);
  EXPECT_FALSE(map->genericMapParams.enableObservationLikelihood);
  EXPECT_EQ(map->options().insertion.interpolation, PoseInterpolation::ConstantVelocity);
  EXPECT_EQ(map->options().insertion.lidarVoxel_m, 0.3);
  EXPECT_EQ(map->options().resolver.gate, 4);
  EXPECT_EQ(map->options().likelihood.sigma_m, 0.5);
  EXPECT_EQ(map->options().view.maxPoints, 77);
}

/// MRPT wraps what is thrown inside its loaders and keeps only the text.
std::string faultOf(const std::string& text) {
  try {
    created(text);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

TEST(MapDefinition, UnknownKeyOrBadValue_IsAnErrorThatNamesIt) {
  const std::string head = "[map]\nseabedSkyMap_count = 1\n[map_seabedSkyMap_00_insertOpts]\n";
  EXPECT_THAT(faultOf(head + "lidar_voxel = 0.3\n"), testing::HasSubstr("unknown key 'lidar_voxel'"));
  EXPECT_THAT(faultOf(head + "lidar_voxel_m = 3.5abc\n"), testing::HasSubstr("'3.5abc' is not a valid value"));
  EXPECT_THAT(faultOf(head + "lidar_voxel_m = -1\n"), testing::HasSubstr("'-1' is not a valid value"));
}

TEST(OptionTables, Defaults_SurvivePrintingAndReading) {
  const auto check = [](auto options) {
    const auto table = optionTable(options);
    auto ini = s2s::core::IniFile::parse(table.print("x"), "printed");
    auto again = options;
    auto reader = optionTable(again);
    reader.load(ini, "x");
    ini.rejectUnread();
    EXPECT_EQ(optionTable(again).print("x"), table.print("x"));
    EXPECT_FALSE(table.keys().empty());
  };
  check(InsertionOptions());
  check(ResolverOptions());
  check(LikelihoodOptions());
  check(ViewOptions());
}

}  // namespace
