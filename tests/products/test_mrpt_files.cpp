#include <gtest/gtest.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/opengl/CSetOfLines.h>

#include "s2s/core/error.h"
#include "s2s/products/mrpt_files.h"
#include "sample_map.h"
#include "temp_folder.h"

namespace s2s::products {
namespace {

using test::TempFolder;
using test::writeBytes;

TEST(SceneBuilder, Scene_ReadsBackWithLayersAndPath) {
  const TempFolder folder;
  const SampleMap map;
  SceneBuilder scene(MapColours(0, 10, -4, 0), 4);
  for (const auto layer : map::kLayers) map.source()(layer, [&](const map::MapPoint& p) { scene.add(p); });
  scene.write(folder.file("a.3Dscene"), map.trajectories().optimised, map.trajectories().keyframes, 0);
  EXPECT_EQ(folder.fileCount(), 1U);
  mrpt::opengl::COpenGLScene back;
  ASSERT_TRUE(back.loadFromFile(folder.file("a.3Dscene")));
  const auto lidar = std::dynamic_pointer_cast<mrpt::opengl::CPointCloudColoured>(back.getByName("lidar"));
  ASSERT_TRUE(lidar);
  EXPECT_EQ(lidar->size(), static_cast<std::size_t>(map.lidarPoints) / 4);
  EXPECT_TRUE(back.getByName("line_vertical"));
  const auto path = std::dynamic_pointer_cast<mrpt::opengl::CSetOfLines>(back.getByName("trajectory"));
  ASSERT_TRUE(path);
  EXPECT_EQ(path->getLineCount(), map.trajectories().optimised.size() - 1);
}

TEST(SceneBuilder, EmptyMap_StillGivesAScene) {
  const TempFolder folder;
  SceneBuilder(MapColours(0, 0, 0, 0), 1).write(folder.file("a.3Dscene"), {}, {}, 0);
  mrpt::opengl::COpenGLScene back;
  EXPECT_TRUE(back.loadFromFile(folder.file("a.3Dscene")));
}

TEST(SimpleMapBuilder, Points_HangOnTheKeyframeNearestInTime) {
  const TempFolder folder;
  core::Trajectory keyframes;
  keyframes.append(10 * core::kNsPerSecond, core::isometryFromXyzYpr(5, 0, 0, M_PI / 2, 0, 0));
  keyframes.append(20 * core::kNsPerSecond, core::isometryFromXyzYpr(10, 0, 0, 0, 0, 0));
  SimpleMapBuilder builder(keyframes, 1);
  map::MapPoint p;
  p.p_map = {5, 2, -1};
  for (const double t : {0.0, 14.0, 16.0, 99.0}) {
    p.time = core::durationNs(t);
    builder.add(p);
  }
  builder.write(folder.file("a.simplemap"));
  mrpt::maps::CSimpleMap back;
  ASSERT_TRUE(back.loadFromFile(folder.file("a.simplemap")));
  ASSERT_EQ(back.size(), 2U);
  const std::array<Eigen::Vector3d, 2> expected = {Eigen::Vector3d(2, 0, -1), Eigen::Vector3d(-5, 2, -1)};
  for (std::size_t i = 0; i < 2; ++i) {
    mrpt::poses::CPose3DPDF::Ptr pose;
    mrpt::obs::CSensoryFrame::Ptr frame;
    back.get(i, pose, frame);
    const auto cloud = frame->getObservationByClass<mrpt::obs::CObservationPointCloud>();
    ASSERT_TRUE(cloud && cloud->pointcloud);
    ASSERT_EQ(cloud->pointcloud->size(), 2U);
    mrpt::math::TPoint3D q;
    cloud->pointcloud->getPoint(0, q);
    // Floats of a few metres.
    EXPECT_LT((Eigen::Vector3d(q.x, q.y, q.z) - expected[i]).norm(), 1e-6);
  }
}

TEST(SimpleMapBuilder, NoKeyframes_GivesAnEmptyMap) {
  const TempFolder folder;
  SimpleMapBuilder builder({}, 1);
  builder.add(map::MapPoint{});
  builder.write(folder.file("a.simplemap"));
  mrpt::maps::CSimpleMap back;
  ASSERT_TRUE(back.loadFromFile(folder.file("a.simplemap")));
  EXPECT_EQ(back.size(), 0U);
}

TEST(MrptFiles, UnwritableFolder_IsAnOutputError) {
  const TempFolder folder;
  writeBytes(folder.file("taken"), "x");
  SceneBuilder scene(MapColours(0, 1, -1, 0), 1);
  EXPECT_THROW(scene.write(folder.file("taken/a.3Dscene"), {}, {}, 0), core::OutputError);
  EXPECT_THROW(SimpleMapBuilder({}, 1).write(folder.file("taken/a.simplemap")), core::OutputError);
  EXPECT_EQ(folder.fileCount(), 1U);
}

TEST(StrideFor, KeepsWithinTheLimit) {
  EXPECT_EQ(strideFor(100, 100), 1U);
  EXPECT_EQ(strideFor(101, 100), 2U);
  EXPECT_EQ(strideFor(0, 1), 1U);
}

}  // namespace
}  // namespace s2s::products
