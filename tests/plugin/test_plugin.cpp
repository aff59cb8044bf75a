#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/io/CFileInputStream.h>
#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/opengl/Visualizable.h>
#include <mrpt/rtti/CObject.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/system/os.h>

#include "plugin_support.h"

namespace {

using namespace s2s::test;

/// The process starts without our classes; loading the plugin is part of what is tested, and it cannot be undone.
class Plugin : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    known_before_ = mrpt::rtti::findRegisteredClass("s2s::obs::CObservationImagingSonar") != nullptr;
    loaded_ = mrpt::system::loadPluginModule(pluginPath(), error_);
  }
  static inline bool known_before_ = true, loaded_ = false;
  static inline std::string error_;
};

mrpt::obs::CObservation::Ptr readFirst(const std::string& name) {
  mrpt::io::CFileInputStream file(dataFile(name));
  auto archive = mrpt::serialization::archiveFrom(file);
  return std::dynamic_pointer_cast<mrpt::obs::CObservation>(archive.ReadObject());
}

TEST_F(Plugin, Loading_MakesOurClassesKnown) {
  EXPECT_FALSE(known_before_) << "the test links our libraries, so it proves nothing";
  ASSERT_TRUE(loaded_) << error_;
  for (const char* name :
       {"s2s::obs::CObservationImagingSonar", "s2s::obs::CObservationLidarSweep", "s2s::map::CSeabedSkyMap"})
    EXPECT_NE(mrpt::rtti::findRegisteredClass(name), nullptr) << name;
}

TEST_F(Plugin, Observations_AreReadDescribedAndDrawn) {
  for (const char* name : {"obs_version_0/imaging_sonar.rawlog", "obs_version_0/lidar_sweep.rawlog"}) {
    const auto observation = readFirst(name);
    ASSERT_TRUE(observation) << name;
    std::ostringstream text;
    observation->getDescriptionAsText(text);
    EXPECT_THAT(text.str(),
                testing::AnyOf(testing::HasSubstr("Imaging sonar ping"), testing::HasSubstr("LiDAR sweep")));
    const auto drawable = std::dynamic_pointer_cast<mrpt::opengl::Visualizable>(observation);
    ASSERT_TRUE(drawable) << name;
    mrpt::opengl::CSetOfObjects scene;
    drawable->getVisualizationInto(scene);
    EXPECT_FALSE(scene.empty()) << name;
  }
}

TEST_F(Plugin, MapDefinition_MakesOurMapAndItTakesOurSweep) {
  const mrpt::config::CConfigFileMemory ini(std::string("[map]\nseabedSkyMap_count = 1\n"));
  mrpt::maps::TSetOfMetricMapInitializers definition;
  definition.loadFromConfigFile(ini, "map");
  mrpt::maps::CMultiMetricMap maps;
  maps.setListOfMaps(definition);
  ASSERT_EQ(maps.maps.size(), 1u);
  EXPECT_STREQ(maps.maps[0]->GetRuntimeClass()->className, "s2s::map::CSeabedSkyMap");
  const auto sweep = readFirst("obs_version_0/lidar_sweep.rawlog");
  ASSERT_TRUE(sweep);
  EXPECT_TRUE(maps.insertObservation(*sweep));
  EXPECT_FALSE(maps.maps[0]->isEmpty());
}

}  // namespace
