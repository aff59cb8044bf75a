#include "ouster2rawlog/sweep_builder.h"

#include <gtest/gtest.h>

#include <cmath>

#include "byte_writer.h"
#include "ouster_bytes.h"
#include "s2s/obs/sweep_projector.h"

using namespace s2s;
using namespace s2s::tools::ouster;
using core::TimeNs;

namespace {

constexpr std::int64_t kOffset = 1'700'000'000'000'000'000;

/// A dual-return sensor whose pixels tell their place; columns 1 ms apart, from 7.000000123 s of its clock.
class SweepBuilderTest : public testing::Test {
 protected:
  SweepBuilderTest() {
    maker_.metadata = metadata_;
    maker_.time = [](std::uint32_t column) { return 7'000'000'123u + 1'000'000u * column; };
    maker_.pixel = [](std::uint32_t row, std::uint32_t column) {
      test::OusterPixel pixel;
      pixel.range = 1000 + 100 * row + column;
      pixel.range2 = 5000 + 100 * row + column;
      pixel.reflectivity = row;
      pixel.signal2 = 256 * column;
      pixel.nearInfrared = 3 * column + row;
      return pixel;
    };
  }

  /// Packets of a frame, `left` out of its four.
  void addFrame(SweepBuilder& builder, std::uint32_t frameId,
                const std::vector<std::uint32_t>& packets = {0, 1, 2, 3}) {
    for (const std::uint32_t p : packets)
      if (auto sweep = builder.add(test::data(maker_.packet(frameId, 8 * p)))) sweeps_.push_back(sweep);
  }
  void finish(SweepBuilder& builder) {
    if (auto sweep = builder.finish()) sweeps_.push_back(sweep);
  }

  Metadata metadata_ = test::ousterMetadata("RNG19_RFL8_SIG16_NIR16_DUAL");
  LidarPacketFormat format_{metadata_};
  test::OusterPacketMaker maker_;
  std::vector<obs::CObservationLidarSweep::Ptr> sweeps_;
};

/// A point by the formula of Ouster's SDK and manual, in metres in the sensor's frame.
Eigen::Vector3d pointBySdk(const Metadata& m, std::uint32_t row, std::uint32_t column, double range_mm) {
  const double rad = M_PI / 180;
  const double encoder = 2 * M_PI * (1 - static_cast<double>(column) / m.columns);
  const double azimuth = -m.beamAzimuth_deg[row] * rad, altitude = m.beamAltitude_deg[row] * rad;
  const double x_mm = 1e3 * m.beamOriginOffset_m, z_mm = 1e3 * m.beamOriginHeight_m, n_mm = std::hypot(x_mm, z_mm);
  const Eigen::Vector3d p_lidar_mm(
      (range_mm - n_mm) * std::cos(encoder + azimuth) * std::cos(altitude) + x_mm * std::cos(encoder),
      (range_mm - n_mm) * std::sin(encoder + azimuth) * std::cos(altitude) + x_mm * std::sin(encoder),
      (range_mm - n_mm) * std::sin(altitude) + z_mm);
  return m.T_sensor_lidar * (1e-3 * p_lidar_mm);
}

}  // namespace

TEST_F(SweepBuilderTest, TwoFrames_BecomeTwoSweepsWithAllLayers) {
  SweepBuilder builder(metadata_, format_, kOffset, true);
  addFrame(builder, 10);
  addFrame(builder, 11);
  finish(builder);
  ASSERT_EQ(sweeps_.size(), 2u);
  const auto& sweep = *sweeps_[1];
  EXPECT_NO_THROW(sweep.checkConsistent());
  EXPECT_EQ(sweep.frameId, 11u);
  ASSERT_EQ(sweep.echoes.size(), 2u);
  for (std::uint32_t row = 0; row < 4; ++row)
    for (std::uint32_t column = 0; column < 32; ++column) {
      const std::size_t i = row * 32 + column;
      EXPECT_EQ(sweep.echoes[0].range[i], 1000 + 100 * row + column);
      EXPECT_EQ(sweep.echoes[1].range[i], 5000 + 100 * row + column);
      EXPECT_EQ(sweep.echoes[0].reflectivity[i], row);
      EXPECT_EQ(sweep.echoes[1].signal[i], 256 * column);
      EXPECT_EQ(sweep.nearInfrared[i], 3 * column + row);
    }
  EXPECT_TRUE(sweep.columnValid.empty());
  EXPECT_TRUE(sweep.echoes[0].flags.empty());  // all 0
}

TEST_F(SweepBuilderTest, ColumnTimes_AreExactToANanosecond) {
  SweepBuilder builder(metadata_, format_, kOffset, true);
  addFrame(builder, 10);
  finish(builder);
  const auto& sweep = *sweeps_.at(0);
  for (std::size_t column = 0; column < 32; ++column)
    EXPECT_EQ(core::fromMrptTime(sweep.timestamp) + sweep.columnTime_ns[column],
              kOffset + 7'000'000'123 + 1'000'000 * static_cast<std::int64_t>(column));
  EXPECT_NEAR(sweep.deviceTime_s, 7.0000001, 1e-12);
}

TEST_F(SweepBuilderTest, Points_EqualTheSdksFormula) {
  SweepBuilder builder(metadata_, format_, kOffset, true);
  addFrame(builder, 10);
  finish(builder);
  obs::SweepProjector projector;
  projector.prepare(*sweeps_.at(0));
  for (std::uint32_t row = 0; row < 4; ++row)
    for (std::uint32_t column = 0; column < 32; ++column)
      for (const std::uint32_t range_mm : {500u, 20'000u, 100'000u}) {
        const Eigen::Vector3d expected = pointBySdk(metadata_, row, column, range_mm);
        // Single precision over up to 100 m.
        EXPECT_LT((projector.point(row, column, range_mm).cast<double>() - expected).norm(),
                  1e-6 * (1 + 1e-3 * range_mm))
            << row << ' ' << column;
      }
}

TEST_F(SweepBuilderTest, LaterColumns_LieClockwiseSeenFromAbove) {
  SweepBuilder builder(metadata_, format_, kOffset, true);
  addFrame(builder, 10);
  finish(builder);
  obs::SweepProjector projector;
  projector.prepare(*sweeps_.at(0));
  // Column 0 looks to the cable, -x of the sensor; a quarter turn clockwise from there is +y.
  const auto back = projector.point(1, 0, 10'000), left = projector.point(1, 8, 10'000);
  EXPECT_LT(back.x(), -9.9);
  EXPECT_GT(left.y(), 9.9);
}

TEST_F(SweepBuilderTest, PositiveBeamAzimuth_IsClockwiseToo) {
  SweepBuilder builder(metadata_, format_, kOffset, true);
  addFrame(builder, 10);
  finish(builder);
  obs::SweepProjector projector;
  projector.prepare(*sweeps_.at(0));
  // Beam 1 has +1 deg: at column 0 (looking to -x) clockwise means toward +y, by 10 m * 1 deg = 0.17 m.
  EXPECT_NEAR(projector.point(1, 0, 10'000).y(), 0.17, 0.01);
}

TEST_F(SweepBuilderTest, LostPacket_LeavesInvalidColumnsWithPlausibleTimes) {
  SweepBuilder builder(metadata_, format_, kOffset, true);
  addFrame(builder, 10, {1, 3});
  finish(builder);
  const auto& sweep = *sweeps_.at(0);
  EXPECT_NO_THROW(sweep.checkConsistent());
  for (std::size_t column = 0; column < 32; ++column) {
    EXPECT_EQ(sweep.isColumnValid(column), (column / 8) % 2 == 1);
    if (!sweep.isColumnValid(column)) {
      EXPECT_EQ(sweep.echoes[0].range[column], 0u);
    }
    if (column > 0) {
      EXPECT_GT(sweep.columnTime_ns[column], sweep.columnTime_ns[column - 1]) << column;
    }
  }
  EXPECT_EQ(core::fromMrptTime(sweep.timestamp) + sweep.columnTime_ns[8], kOffset + 7'000'000'123 + 8'000'000);
  EXPECT_EQ(builder.statistics().incompleteSweeps, 1u);
  EXPECT_EQ(builder.statistics().missingColumns, 16u);
}

TEST_F(SweepBuilderTest, PacketOfTheSweepBefore_IsCountedAsLate) {
  SweepBuilder builder(metadata_, format_, kOffset, true);
  addFrame(builder, 10, {0, 1, 2});
  addFrame(builder, 11, {0});
  addFrame(builder, 10, {3});
  addFrame(builder, 11, {1, 2, 3});
  finish(builder);
  EXPECT_EQ(sweeps_.size(), 2u);
  EXPECT_EQ(builder.statistics().lateColumns, 8u);
  EXPECT_TRUE(sweeps_[1]->columnValid.empty());
}

TEST_F(SweepBuilderTest, FrameNumbersThatWrap_AreSweepsLikeOthers) {
  SweepBuilder builder(metadata_, format_, kOffset, true);
  addFrame(builder, 65535);
  addFrame(builder, 0);
  finish(builder);
  EXPECT_EQ(sweeps_.size(), 2u);
}

TEST_F(SweepBuilderTest, ColumnsThatCannotBe_AreCountedAndLeftOut) {
  maker_.time = [](std::uint32_t column) {
    return column == 5 ? 99'000'000'000u : 7'000'000'000u + 1'000'000u * column;
  };
  SweepBuilder builder(metadata_, format_, kOffset, true);
  addFrame(builder, 10);
  builder.add(test::data(maker_.packet(10, 40)));  // columns 40 to 47 of 32
  finish(builder);
  EXPECT_EQ(builder.statistics().impossibleColumns, 9u);
  EXPECT_FALSE(sweeps_.at(0)->isColumnValid(5));
}

TEST_F(SweepBuilderTest, SweepWithoutValidColumn_IsNotDelivered) {
  maker_.valid = [](std::uint32_t) { return false; };
  SweepBuilder builder(metadata_, format_, kOffset, true);
  addFrame(builder, 10);
  addFrame(builder, 11);
  finish(builder);
  EXPECT_TRUE(sweeps_.empty());
  EXPECT_EQ(builder.statistics().emptySweeps, 2u);
}

TEST_F(SweepBuilderTest, AzimuthWindow_KeepsOnlyItsColumns) {
  metadata_.firstColumn = 10;
  metadata_.lastColumn = 20;
  maker_.valid = [](std::uint32_t column) { return column >= 10 && column <= 20; };
  SweepBuilder builder(metadata_, format_, kOffset, true);
  addFrame(builder, 10, {1, 2});
  finish(builder);
  const auto& sweep = *sweeps_.at(0);
  EXPECT_EQ(sweep.columnCount, 11u);
  EXPECT_TRUE(sweep.columnValid.empty());
  EXPECT_EQ(sweep.echoes[0].range[0], 1010u);
  EXPECT_FLOAT_EQ(sweep.columnAzimuth_rad[0], static_cast<float>(-2 * M_PI * 10 / 32));
  EXPECT_EQ(core::fromMrptTime(sweep.timestamp) + sweep.columnTime_ns[0], kOffset + 7'000'000'123 + 10'000'000);
}

TEST_F(SweepBuilderTest, WindowThatSpansColumn0_KeepsTheWholeTurn) {
  metadata_.firstColumn = 24;
  metadata_.lastColumn = 7;
  maker_.valid = [](std::uint32_t column) { return column >= 24 || column <= 7; };
  SweepBuilder builder(metadata_, format_, kOffset, true);
  addFrame(builder, 10, {0, 3});
  finish(builder);
  EXPECT_EQ(sweeps_.at(0)->columnCount, 32u);
  EXPECT_TRUE(sweeps_[0]->isColumnValid(31));
  EXPECT_FALSE(sweeps_[0]->isColumnValid(8));
}

TEST_F(SweepBuilderTest, WindowThatSpansColumn0_BeginsWithItsEarliestColumn) {
  metadata_.firstColumn = 24;
  metadata_.lastColumn = 7;
  maker_.valid = [](std::uint32_t column) { return column >= 24 || column <= 7; };
  maker_.time = [](std::uint32_t column) { return 7'000'000'000u + 1'000'000u * ((column + 8) % 32); };
  SweepBuilder builder(metadata_, format_, kOffset, true);
  addFrame(builder, 10, {3, 0});
  finish(builder);
  EXPECT_EQ(core::fromMrptTime(sweeps_.at(0)->timestamp), kOffset + 7'000'000'000);
  EXPECT_EQ(sweeps_[0]->columnTime_ns[24], 0);
  EXPECT_EQ(sweeps_[0]->columnTime_ns[7], 15'000'000);
}
