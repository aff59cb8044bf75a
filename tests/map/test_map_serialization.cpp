#include <gtest/gtest.h>
#include <mrpt/io/CFileInputStream.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/serialization/CArchive.h>

#include "s2s/map/register_classes.h"
#include "sample_map.h"
#include "temp_folder.h"

namespace {

using namespace s2s::map;
using s2s::test::sampleMap;

std::string bytesOf(const CSeabedSkyMap& map) {
  mrpt::io::CMemoryStream memory;
  auto archive = mrpt::serialization::archiveFrom(memory);
  archive << map;
  return {static_cast<const char*>(memory.getRawBufferData()), static_cast<std::size_t>(memory.getTotalBytesCount())};
}

CSeabedSkyMap::Ptr mapFrom(const std::string& bytes) {
  mrpt::io::CMemoryStream memory(bytes.data(), bytes.size());
  auto archive = mrpt::serialization::archiveFrom(memory);
  return std::dynamic_pointer_cast<CSeabedSkyMap>(archive.ReadObject());
}

std::vector<MapPoint> allPoints(const CSeabedSkyMap& map) {
  std::vector<MapPoint> points;
  for (const Layer layer : kLayers) map.forEachPoint(layer, [&points](const MapPoint& p) { points.push_back(p); });
  return points;
}

void expectSample(const CSeabedSkyMap& map) {
  const CSeabedSkyMap sample = sampleMap();
  EXPECT_FALSE(map.genericMapParams.enableObservationLikelihood);
  EXPECT_EQ(map.options().insertion.interpolation, PoseInterpolation::ConstantVelocity);
  EXPECT_EQ(map.options().insertion.lidarVoxel_m, 0.25);
  EXPECT_EQ(map.options().insertion.stereoWindow_s, 0.07);
  EXPECT_EQ(map.options().resolver.gate, 2.5);
  EXPECT_EQ(map.options().likelihood.decimation, 3);
  EXPECT_EQ(map.options().view.maxPoints, 1234);
  ASSERT_EQ(map.keyframes().size(), 2u);
  EXPECT_EQ(map.keyframes()[1].id, 9u);
  EXPECT_EQ(map.keyframes()[1].time, 3000);
  const auto points = allPoints(map), expected = allPoints(sample);
  ASSERT_EQ(points.size(), 7u);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_LT((points[i].p_map - expected[i].p_map).norm(), 1e-12) << i;  // sines may differ in the last bit
    EXPECT_EQ(points[i].intensity, expected[i].intensity);
    EXPECT_EQ(points[i].sigma_m, expected[i].sigma_m);
    EXPECT_EQ(points[i].interval_m, expected[i].interval_m);
    EXPECT_EQ(points[i].time, expected[i].time);
    EXPECT_EQ(points[i].layer, expected[i].layer);
  }
  for (const Layer layer : kLayers) EXPECT_EQ(map.elevationSources(layer), sample.elevationSources(layer));
}

class MapSerialization : public testing::Test {
 protected:
  static void SetUpTestSuite() { registerClasses(); }
};

TEST_F(MapSerialization, RoundTrip_KeepsEverything) {
  const auto map = mapFrom(bytesOf(sampleMap()));
  ASSERT_TRUE(map);
  expectSample(*map);
}

TEST_F(MapSerialization, ByteImageOfVersion0_IsRead) {
  const auto map = mapFrom(s2s::test::readBytes(std::string(S2S_SOURCE_DIR) + "/tests/data/map_version_0/map.bin"));
  ASSERT_TRUE(map);
  // Version 0 knew no ambiguous returns: all whose elevation nothing decided were of this kind.
  EXPECT_EQ(map->elevationSources(Layer::LineHorizontal)[static_cast<std::size_t>(ElevationSource::LowestPoint)], 2u);
  map->resolveLineScans();
  expectSample(*map);
}

TEST_F(MapSerialization, ByteImageOfVersion1_IsRead) {
  const auto map = mapFrom(s2s::test::readBytes(std::string(S2S_SOURCE_DIR) + "/tests/data/map_version_1/map.bin"));
  ASSERT_TRUE(map);
  expectSample(*map);
}

TEST_F(MapSerialization, ReadMap_GoesOnThinningWhereTheOldOneWas) {
  const auto map = mapFrom(bytesOf(sampleMap()));
  const auto T_odom_vehicle = s2s::core::isometryFromXyzYpr(1.5, 2, 3, 0.1, 0.2, 0.3);
  EXPECT_EQ(map->insertScan(Layer::Lidar, 2500, T_odom_vehicle, {{{3, 4, 5}, 1, 0}}), 0u);
}

TEST_F(MapSerialization, ReadIntoAUsedMap_ReplacesItsContent) {
  CSeabedSkyMap used = sampleMap();
  const std::string bytes = bytesOf(CSeabedSkyMap());
  mrpt::io::CMemoryStream memory(bytes.data(), bytes.size());
  auto archive = mrpt::serialization::archiveFrom(memory);
  archive.ReadObject(&used);
  EXPECT_TRUE(used.isEmpty());
  EXPECT_TRUE(used.keyframes().empty());
}

TEST_F(MapSerialization, EveryTruncation_ThrowsAndCrashesNot) {
  const std::string bytes = bytesOf(sampleMap());
  for (std::size_t size = 1; size < bytes.size(); size += 7) EXPECT_ANY_THROW(mapFrom(bytes.substr(0, size))) << size;
}

TEST_F(MapSerialization, CopyOfAMultiMetricMap_KeepsOurMap) {
  mrpt::maps::CMultiMetricMap maps;
  maps.maps.push_back(std::make_shared<CSeabedSkyMap>(sampleMap()));
  const mrpt::maps::CMultiMetricMap copy(maps);
  maps.maps.clear();
  const auto map = std::dynamic_pointer_cast<CSeabedSkyMap>(copy.maps.at(0));
  ASSERT_TRUE(map);
  expectSample(*map);
}

}  // namespace
