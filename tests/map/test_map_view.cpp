#include <gtest/gtest.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CPointCloudColoured.h>
#include <mrpt/opengl/CSetOfObjects.h>

#include <fstream>

#include "s2s/core/error.h"
#include "sample_map.h"
#include "temp_folder.h"

namespace {

using namespace s2s::map;
using s2s::core::Isometry;

TEST(MapView, EachLayer_IsACloudNamedAfterIt) {
  auto map = s2s::test::sampleMap();
  mrpt::opengl::CSetOfObjects scene;
  map.getVisualizationInto(scene);
  for (const Layer layer : kLayers) {
    const auto cloud = std::dynamic_pointer_cast<mrpt::opengl::CPointCloudColoured>(scene.getByName(layerName(layer)));
    ASSERT_TRUE(cloud) << layerName(layer);
    EXPECT_EQ(cloud->size(), map.pointCount(layer));
  }
}

TEST(MapView, MorePointsThanTheLimit_AreThinnedEvenly) {
  MapOptions options;
  options.view.maxPoints = 1000;
  CSeabedSkyMap map(options);
  std::vector<ScanPoint> line;
  for (int i = 0; i < 10000; ++i) line.push_back({{0.01f * static_cast<float>(i), 0, 0}, 0, 0});
  map.insertScan(Layer::Stereo, 0, Isometry::Identity(), line);
  mrpt::opengl::CSetOfObjects scene;
  map.getVisualizationInto(scene);
  const auto cloud = scene.getByClass<mrpt::opengl::CPointCloudColoured>();
  ASSERT_TRUE(cloud);
  EXPECT_EQ(cloud->size(), 1000u);
  EXPECT_FLOAT_EQ(cloud->getPoint3Df(999).x, 99.9f);  // one of ten, to the end of the line
}

TEST(MapView, SwitchedOff_ShowsNothing) {
  auto map = s2s::test::sampleMap();
  map.genericMapParams.enableSaveAs3DObject = false;
  mrpt::opengl::CSetOfObjects scene;
  map.getVisualizationInto(scene);
  EXPECT_TRUE(scene.empty());
}

TEST(MapView, SavedFiles_HoldAllPoints) {
  const s2s::test::TempFolder folder;
  const auto map = s2s::test::sampleMap();
  map.saveMetricMapRepresentationToFile(folder.file("out"));
  for (const Layer layer : kLayers) {
    std::ifstream file(folder.file(std::string("out_") + layerName(layer) + ".txt"));
    std::string line;
    std::size_t count = 0;
    while (std::getline(file, line)) count += line.front() != '%';
    EXPECT_EQ(count, map.pointCount(layer)) << layerName(layer);
  }
  mrpt::opengl::COpenGLScene scene;
  ASSERT_TRUE(scene.loadFromFile(folder.file("out.3Dscene")));
  EXPECT_TRUE(scene.getByName("lidar"));
  EXPECT_EQ(folder.fileCount(), 5u);
}

TEST(MapView, FolderThatCannotBeMade_IsAnOutputError) {
  EXPECT_THROW(s2s::test::sampleMap().saveMetricMapRepresentationToFile("/proc/no/such/folder/out"),
               s2s::core::OutputError);
}

}  // namespace
