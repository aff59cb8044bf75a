#include <gtest/gtest.h>
#include <mrpt/maps/CSimplePointsMap.h>

#include <set>

#include "s2s/core/error.h"
#include "s2s/odometry/scan_maker.h"
#include "synthetic.h"

namespace s2s::odometry {
namespace {

using namespace synthetic;

obs::CObservationLidarSweep someSweep() {
  Random random(1);
  Lidar lidar;
  lidar.rows = 64;
  lidar.columns = 512;
  return sweepAt(room(), roomPath(), 1.0, lidar, random);
}

TEST(ScanMaker, AllPixels_GiveAllReturnsWithTheirTimes) {
  const auto sweep = someSweep();
  ScanOptions options;
  options.rowStride = options.columnStride = 1;
  const Scan scan = ScanMaker(options).fromSweep(sweep);
  EXPECT_EQ(scan.points_sensor.size(), sweep.returnCount());
  ASSERT_EQ(scan.offset_s.size(), scan.points_sensor.size());
  EXPECT_EQ(scan.time, timeOf(1.0));
  EXPECT_NEAR(scan.duration_s, sweep.duration_s(), 1e-9);
  EXPECT_EQ(scan.offset_s.front(), 0);
  EXPECT_NEAR(scan.offset_s.back(), scan.duration_s, 1e-6);
}

TEST(ScanMaker, AutomaticStride_KeepsTheCountAndVisitsAllPixelsInTime) {
  auto sweep = someSweep();
  sweep.beamOriginOffset_m = 0;
  ScanOptions options;
  options.maxPoints = 4096;
  ScanMaker maker(options);
  std::set<float> offsets;
  for (int i = 0; i < 20; ++i) {
    const Scan scan = maker.fromSweep(sweep);
    EXPECT_LE(scan.points_sensor.size(), 4300U);  // uneven division may add a row or column
    EXPECT_GT(scan.points_sensor.size(), 2000U);
    offsets.insert(scan.offset_s.begin(), scan.offset_s.end());
  }
  EXPECT_EQ(offsets.size(), 512U);  // every column had its turn
}

TEST(ScanMaker, FewReturns_AllAreLookedAt) {
  auto sweep = someSweep();
  // Open water: one return in twenty beams.
  auto& range = sweep.echoes.front().range;
  for (std::size_t i = 0; i < range.size(); ++i)
    if (i % 20 != 0) range[i] = 0;
  ScanOptions options;
  options.maxPoints = 4096;
  EXPECT_EQ(ScanMaker(options).fromSweep(sweep).points_sensor.size(), sweep.returnCount());
}

TEST(ScanMaker, InvalidColumnsAndRangeLimits_AreLeftOut) {
  auto sweep = someSweep();
  sweep.columnValid.assign(sweep.columnCount, 1);
  for (std::size_t column = 0; column < 256; ++column) sweep.columnValid[column] = 0;
  ScanOptions options;
  options.rowStride = options.columnStride = 1;
  options.minRange_m = 6;
  options.maxRange_m = 9;
  const Scan scan = ScanMaker(options).fromSweep(sweep);
  EXPECT_EQ(scan.points_sensor.size() + scan.outOfRangeCount, sweep.returnCount() / 2);
  for (const auto& p : scan.points_sensor) {
    EXPECT_GE(p.norm(), 5.999F);
    EXPECT_LE(p.norm(), 9.001F);
  }
}

TEST(ScanMaker, ContradictorySweep_IsRefused) {
  auto sweep = someSweep();
  sweep.echoes[0].range.pop_back();
  EXPECT_THROW(ScanMaker({}).fromSweep(sweep), core::InputError);
}

TEST(ScanMaker, CloudWithNotFinitePoints_KeepsTheOthers) {
  auto points = mrpt::maps::CSimplePointsMap::Create();
  points->insertPoint(3.0F, 0.0F, 0.0F);
  points->insertPoint(std::nanf(""), 0.0F, 0.0F);
  points->insertPoint(0.0F, 400.0F, 0.0F);
  mrpt::obs::CObservationPointCloud cloud;
  cloud.pointcloud = points;
  cloud.timestamp = core::toMrptTime(timeOf(2));
  const Scan scan = ScanMaker({}).fromCloud(cloud);
  ASSERT_EQ(scan.points_sensor.size(), 1U);
  EXPECT_EQ(scan.outOfRangeCount, 2U);
  EXPECT_TRUE(scan.offset_s.empty());
  EXPECT_TRUE(ScanMaker({}).fromCloud(mrpt::obs::CObservationPointCloud()).points_sensor.empty());
}

}  // namespace
}  // namespace s2s::odometry
