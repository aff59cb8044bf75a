#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <set>

#include "error_text.h"
#include "s2s/core/error.h"
#include "s2s/map/CSeabedSkyMap.h"
#include "s2s/products/grid_files.h"
#include "s2s/products/options_table.h"
#include "s2s/products/ply_reader.h"
#include "s2s/products/trajectory_files.h"
#include "sample_map.h"
#include "temp_folder.h"

namespace s2s::products {
namespace {

using test::errorText;
using test::readBytes;
using test::TempFolder;
using test::writeBytes;

RunSummary sampleSummary(const SampleMap& map) {
  RunSummary summary;
  summary.inputs = {"survey.rawlog"};
  summary.startTime = map.start;
  summary.endTime = map.timeAt(map.length_m);
  summary.duration_s = map.length_m;
  summary.wall_s = 12;
  summary.waterHeight_m = 0;
  return summary;
}

/// As the defaults, with small pictures to save time.
ProductsOptions quickOptions() {
  ProductsOptions options;
  options.pictures.width_px = 400;
  options.pictures.height_px = 300;
  return options;
}

std::set<std::string> names(const ProductsResult& result) {
  std::set<std::string> out;
  for (const auto& file : result.files) out.insert(file.name);
  return out;
}

TEST(WriteProducts, Everything_IsThereWithTheStatedNamesAndSizes) {
  const TempFolder folder;
  const SampleMap map;
  ProductsOptions options = quickOptions();
  options.mapPly = options.simpleMap = options.kitti = true;
  std::vector<std::string> announced;
  const auto result = writeProducts(map.source(), map.trajectories(), sampleSummary(map), options, folder.file("out"),
                                    [&](const std::string& name) { announced.push_back(name); });
  for (const char* name :
       {"trajectory.tum", "odometry.tum", "keyframes.tum", "trajectory.kitti", "trajectory_times.txt", "lidar.ply",
        "stereo.ply", "line_horizontal.ply", "line_vertical.ply", "map.ply", "map.las", "seabed.tif", "seabed.bag",
        "map.3Dscene", "map.simplemap", "map.png", "summary.json", "report.html"})
    EXPECT_EQ(names(result).count(name), 1U) << name;
  EXPECT_EQ(folder.fileCount(), result.files.size()) << "nothing else, and nothing half written";
  EXPECT_EQ(announced.size(), result.files.size());
  for (const auto& file : result.files)
    EXPECT_EQ(file.bytes, std::filesystem::file_size(folder.file("out/" + file.name))) << file.name;
}

TEST(WriteProducts, Files_AgreeWithTheMap) {
  const TempFolder folder;
  const SampleMap map;
  const auto result =
      writeProducts(map.source(), map.trajectories(), sampleSummary(map), quickOptions(), folder.path());
  std::size_t i = 0;
  const auto stereo = readPlyPoints(folder.file("stereo.ply"));
  map.source()(map::Layer::Stereo, [&](const map::MapPoint& p) { EXPECT_EQ(stereo.at(i++).p, p.p_map); });
  EXPECT_EQ(i, stereo.size());
  const auto tum = readTum(folder.file("trajectory.tum"));
  EXPECT_EQ(tum.size(), map.trajectories().optimised.size());
  const HeightGrid grid = readGrid(folder.file("seabed.tif"));
  // 30 soundings a cell with 2 cm noise; the bed falls 8 mm within a cell.
  EXPECT_NEAR(grid.heightAt(30.25, 0.25).value(), map.bedHeight(30.25), 0.02);
  EXPECT_NEAR(grid.heightAt(30.25, 9.75).value(), map.bedHeight(30.25), 0.05) << "beside the quay";
  const auto json = nlohmann::json::parse(readBytes(folder.file("summary.json")));
  EXPECT_EQ(json["points"]["lidar"], map.lidarPoints);
  EXPECT_EQ(json["points"]["stereo"], map.sonarPoints);
  EXPECT_GE(json["wall_s"].get<double>(), 12);
  EXPECT_GT(json["peak_rss_mb"].get<double>(), 1);
  EXPECT_EQ(json["warnings"].size(), 0U);
  EXPECT_NEAR(result.seabed.area_m2, 60 * 20, 60);  // a cell's width more or less at the quays
}

TEST(WriteProducts, SameMapTwice_GivesTheSameBytes) {
  const TempFolder folder;
  const SampleMap map;
  for (const char* dir : {"a", "b"})
    writeProducts(map.source(), map.trajectories(), sampleSummary(map), quickOptions(), folder.file(dir));
  // Not compared: summary.json and the report hold run times; BAG holds the time at which HDF5 made its objects.
  for (const char* name : {"trajectory.tum", "lidar.ply", "line_vertical.ply", "map.las", "seabed.tif"})
    EXPECT_EQ(readBytes(folder.file(std::string("a/") + name)), readBytes(folder.file(std::string("b/") + name)))
        << name;
}

TEST(WriteProducts, MapAsSource_GivesItsPointsWhereTheKeyframesPutThem) {
  const TempFolder folder;
  map::CSeabedSkyMap map;
  map::Keyframe keyframe;
  keyframe.T_map_vehicle = core::isometryFromXyzYpr(10, 0, 0, M_PI / 2, 0, 0);
  map.addKeyframe(keyframe);
  map::ScanPoint point;
  point.p_vehicle = {2, 0, 1};
  map.insertScan(map::Layer::Stereo, 0, core::Isometry::Identity(), {point});
  writeProducts(map, {}, {}, quickOptions(), folder.path());
  const auto points = readPlyPoints(folder.file("stereo.ply"));
  ASSERT_EQ(points.size(), 1U);
  // The map keeps points as floats.
  EXPECT_LT((points[0].p - Eigen::Vector3d(10, 2, 1)).norm(), 1e-5);
}

TEST(WriteProducts, MapAsSource_GivesTheSeabedOfTheMapsOwnSurface) {
  const TempFolder folder;
  map::MapOptions mapOptions;
  mapOptions.surface.cell_m = 2;
  map::CSeabedSkyMap map(mapOptions);
  std::vector<map::ScanPoint> bed;
  for (int row = 0; row < 10; ++row)
    for (int column = 0; column < 10; ++column)
      bed.push_back({{0.1F * static_cast<float>(column), 0.1F * static_cast<float>(row), -4}, 100, 0.05F});
  map.insertScan(map::Layer::Stereo, 0, core::Isometry::Identity(), bed);
  auto options = quickOptions();
  options.geoTiff = true;
  options.grid.cell_m = 0.5;
  writeProducts(map, {}, {}, options, folder.path());
  EXPECT_EQ(readGrid(folder.file("seabed.tif")).cell_m, 2);  // not estimated anew from the points
}

TEST(WriteProducts, NoPointsAtAll_GivesEmptyLayersAndAWarning) {
  const TempFolder folder;
  const PointSource nothing = [](map::Layer, const PointVisitor&) {};
  const auto result = writeProducts(nothing, {}, {}, quickOptions(), folder.path());
  EXPECT_TRUE(readPlyPoints(folder.file("lidar.ply")).empty());
  EXPECT_EQ(names(result).count("seabed.tif"), 0U);
  EXPECT_THAT(result.summary.warnings, testing::Contains(testing::HasSubstr("no seabed grid")));
}

TEST(WriteProducts, BrokenPoints_AreLeftOutAndReported) {
  const TempFolder folder;
  const PointSource source = [](map::Layer layer, const PointVisitor& visit) {
    map::MapPoint p;
    p.layer = layer;
    visit(p);
    p.p_map.y() = std::nan("");
    visit(p);
  };
  const auto result = writeProducts(source, {}, {}, quickOptions(), folder.path());
  EXPECT_EQ(readPlyPoints(folder.file("lidar.ply")).size(), 1U);
  EXPECT_THAT(result.summary.warnings, testing::Contains(testing::HasSubstr("4 map points were not finite")));
}

TEST(WriteProducts, StrayPointsWorldsAway_CostOnlyThemselves) {
  const TempFolder folder;
  const SampleMap map;
  const PointSource source = [&](map::Layer layer, const PointVisitor& visit) {
    map.source()(layer, visit);
    map::MapPoint stray;
    stray.layer = layer;
    stray.p_map = {5e7, 5e7, -3};
    for (int i = 0; i < 3; ++i) visit(stray);
  };
  const auto result = writeProducts(source, map.trajectories(), sampleSummary(map), quickOptions(), folder.path());
  EXPECT_THAT(result.summary.warnings, testing::Contains(testing::HasSubstr("no seabed grid")));
  EXPECT_THAT(result.summary.warnings, testing::Contains(testing::HasSubstr("12 points lie too far away for LAS")));
  std::uint64_t lasCount = 0;
  std::memcpy(&lasCount, readBytes(folder.file("map.las")).data() + 247, sizeof lasCount);
  EXPECT_EQ(lasCount, static_cast<std::uint64_t>(map.lidarPoints + 3 * map.sonarPoints));
}

TEST(WriteProducts, OnLand_NoWaterIsInvented) {
  const TempFolder folder;
  const SampleMap map;
  RunSummary summary = sampleSummary(map);
  summary.waterHeight_m.reset();
  const auto result = writeProducts(map.source(), map.trajectories(), summary, quickOptions(), folder.path());
  EXPECT_FALSE(result.summary.waterHeight_m.has_value());
  EXPECT_TRUE(result.summary.warnings.empty());
  EXPECT_FALSE(readSummary(folder.file("summary.json")).waterHeight_m.has_value());
  EXPECT_THAT(readBytes(folder.file("report.html")), testing::Not(testing::HasSubstr("<dt>Depths")));
}

TEST(WriteProducts, FolderIsAFile_IsAnOutputErrorAndLeavesNothing) {
  const TempFolder folder;
  writeBytes(folder.file("taken"), "x");
  const SampleMap map;
  EXPECT_THROW(
      writeProducts(map.source(), map.trajectories(), sampleSummary(map), quickOptions(), folder.file("taken/out")),
      core::OutputError);
  EXPECT_EQ(folder.fileCount(), 1U);
}

TEST(ProductsOptions, Table_ReadsBackItsOwnPrint) {
  ProductsOptions options;
  options.las = false;
  options.grid.cell_m = 0.25;
  options.pictures.width_px = 800;
  auto ini = core::IniFile::parse(optionTable(options).print("products"), "test.ini");
  ProductsOptions back;
  optionTable(back).load(ini, "products");
  ini.rejectUnread();
  EXPECT_FALSE(back.las);
  EXPECT_EQ(back.grid.cell_m, 0.25);
  EXPECT_EQ(back.pictures.width_px, 800);
  EXPECT_TRUE(back.bag);
}

TEST(ProductsOptions, CellOfZero_IsRefused) {
  auto ini = core::IniFile::parse("[products]\ngrid_cell_m = 0\n", "test.ini");
  ProductsOptions options;
  EXPECT_THAT(errorText<core::ConfigError>([&] { optionTable(options).load(ini, "products"); }),
              testing::HasSubstr("grid_cell_m"));
}

}  // namespace
}  // namespace s2s::products
