#include <gtest/gtest.h>

#include "full_disk.h"
#include "picture_drawing.h"
#include "s2s/core/error.h"
#include "s2s/products/grid_files.h"
#include "s2s/products/las_writer.h"
#include "s2s/products/mrpt_files.h"
#include "s2s/products/ply_writer.h"
#include "s2s/products/trajectory_files.h"
#include "sample_map.h"
#include "temp_folder.h"

namespace s2s::products {
namespace {

using test::FullDisk;
using test::TempFolder;

HeightGrid roughGrid() {
  HeightGrid grid(0, 0, 0.5, 200, 200);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> height(-5, -3);
  for (auto& value : grid.height_m) value = height(random);
  grid.sigma_m = grid.height_m;
  return grid;
}

/// Wherever the disk gets full, at half the file or at its last byte, `write(path)` must throw an OutputError and leave
/// the folder empty.
template <class Write>
void expectNothingLeft(const std::string& name, const Write& write) {
  const TempFolder good;
  write(good.file(name));
  const auto size = static_cast<rlim_t>(std::filesystem::file_size(good.file(name)));
  for (const rlim_t room : {size / 2, size - 1}) {
    const TempFolder folder;
    {
      const FullDisk disk(room);
      EXPECT_THROW(write(folder.file(name)), core::OutputError) << name << ", room for " << room << " of " << size;
    }
    EXPECT_EQ(folder.fileCount(), 0U) << name << ", room for " << room << " of " << size;
  }
}

TEST(FullDisk, PointClouds_LeaveNothing) {
  const SampleMap map;
  expectNothingLeft("a.ply", [&](const std::string& path) {
    PlyPointWriter writer(path);
    map.source()(map::Layer::Lidar, [&](const map::MapPoint& p) { writer.add(p); });
    writer.finish();
  });
  expectNothingLeft("a.las", [&](const std::string& path) {
    LasWriter writer(path, LasFrame{});
    map.source()(map::Layer::Lidar, [&](const map::MapPoint& p) { writer.add(p); });
    writer.finish();
  });
}

TEST(FullDisk, Grids_LeaveNothing) {
  const HeightGrid grid = roughGrid();
  expectNothingLeft("a.tif", [&](const std::string& path) { writeGeoTiff(path, grid); });
  expectNothingLeft("a.bag", [&](const std::string& path) { writeBag(path, grid, 0); });
}

TEST(FullDisk, Trajectories_LeaveNothing) {
  const auto trajectory = SampleMap().trajectories().optimised;
  expectNothingLeft("a.tum", [&](const std::string& path) { writeTum(path, trajectory); });
  expectNothingLeft("a.kitti", [&](const std::string& path) { writeKitti(path, trajectory); });
}

TEST(FullDisk, MrptFilesAndPictures_LeaveNothing) {
  const SampleMap map;
  const auto trajectories = map.trajectories();
  expectNothingLeft("a.3Dscene", [&](const std::string& path) {
    SceneBuilder scene(MapColours(0, 10, -4, 0), 1);
    map.source()(map::Layer::Lidar, [&](const map::MapPoint& p) { scene.add(p); });
    scene.write(path, trajectories.optimised, trajectories.keyframes, 0);
  });
  expectNothingLeft("a.simplemap", [&](const std::string& path) {
    SimpleMapBuilder builder(trajectories.keyframes, 1);
    map.source()(map::Layer::Lidar, [&](const map::MapPoint& p) { builder.add(p); });
    builder.write(path);
  });
  expectNothingLeft("a.png", [&](const std::string& path) {
    cv::Mat noise(200, 200, CV_8UC3);
    cv::randu(noise, 0, 255);
    writePicture(path, noise);
  });
}

}  // namespace
}  // namespace s2s::products
