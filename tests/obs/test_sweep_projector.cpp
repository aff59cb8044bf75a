#include "s2s/obs/sweep_projector.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sample_observations.h"

using namespace s2s;

namespace {

/// The formula of CObservationLidarSweep's header, in double.
Eigen::Vector3d pointByFormula(const obs::CObservationLidarSweep& s, std::size_t row, std::size_t column,
                               std::uint32_t counts) {
  const double a = s.beamOriginOffset_m, b = s.beamOriginHeight_m, n = std::sqrt(a * a + b * b);
  const double r = counts * s.rangeResolution_m, azimuth = s.columnAzimuth_rad[column];
  const double theta = azimuth + (s.beamAzimuth_rad.empty() ? 0.0 : s.beamAzimuth_rad[row]);
  const double altitude = s.beamAltitude_rad[row];
  const Eigen::Vector3d p_lidar((r - n) * std::cos(altitude) * std::cos(theta) + a * std::cos(azimuth),
                                (r - n) * std::cos(altitude) * std::sin(theta) + a * std::sin(azimuth),
                                (r - n) * std::sin(altitude) + b);
  return core::toIsometry(s.T_sensor_lidar) * p_lidar;
}

/// A sensor of 16 beams and 256 columns, the beams' origin well off the axis.
obs::CObservationLidarSweep bigSweep() {
  obs::CObservationLidarSweep sweep;
  sweep.rowCount = 16;
  sweep.columnCount = 256;
  sweep.echoes.resize(1);
  sweep.echoes[0].range.assign(sweep.pixelCount(), 0);
  sweep.beamOriginOffset_m = 0.03;
  sweep.beamOriginHeight_m = 0.04;
  sweep.T_sensor_lidar = mrpt::poses::CPose3D(0.01, -0.02, 0.04, 3, 0.1, -0.2);
  for (int row = 0; row < 16; ++row) {
    sweep.beamAltitude_rad.push_back(0.8f - 0.1f * static_cast<float>(row));
    sweep.beamAzimuth_rad.push_back(0.05f * static_cast<float>(row % 4));
  }
  for (int column = 0; column < 256; ++column)
    sweep.columnAzimuth_rad.push_back(static_cast<float>(-2 * M_PI * column / 256));
  return sweep;
}

void expectFormula(const obs::CObservationLidarSweep& sweep, const obs::SweepProjector& projector) {
  for (std::size_t row = 0; row < sweep.rowCount; ++row)
    for (std::size_t column = 0; column < sweep.columnCount; ++column)
      for (const std::uint32_t counts : {1u, 500u, 20'000u, 150'000u}) {
        const Eigen::Vector3d expected = pointByFormula(sweep, row, column, counts);
        // Single precision: a few roundings of 6e-8 each, relative to the range of up to 150 m.
        const double tolerance = 1e-6 + 5e-7 * expected.norm();
        ASSERT_LT((projector.point(row, column, counts).cast<double>() - expected).norm(), tolerance)
            << row << ' ' << column << ' ' << counts;
      }
}

}  // namespace

TEST(SweepProjector, ManyPixels_EqualTheFormulaInDouble) {
  const auto sweep = bigSweep();
  obs::SweepProjector projector;
  projector.prepare(sweep);
  expectFormula(sweep, projector);
}

TEST(SweepProjector, BeamsFromOneOrigin_AreSphericalCoordinates) {
  auto sweep = bigSweep();
  sweep.beamOriginOffset_m = sweep.beamOriginHeight_m = 0;
  sweep.T_sensor_lidar = mrpt::poses::CPose3D();
  obs::SweepProjector projector;
  projector.prepare(sweep);
  const auto p = projector.point(8, 64, 10'000);  // altitude 0, a quarter turn clockwise, beam azimuth 0
  EXPECT_NEAR(p.x(), 0, 1e-5);
  EXPECT_NEAR(p.y(), -10, 1e-5);
  EXPECT_NEAR(p.z(), 0, 1e-5);
}

TEST(SweepProjector, SecondSweepWithOtherGeometry_IsProjectedByItsOwn) {
  auto sweep = bigSweep();
  obs::SweepProjector projector;
  projector.prepare(sweep);
  sweep.rangeResolution_m = 0.004;
  sweep.beamOriginOffset_m = 0;
  sweep.T_sensor_lidar = mrpt::poses::CPose3D(1, 2, 3, 0, 0, 0);
  sweep.beamAltitude_rad[3] = 0.123f;
  sweep.beamAzimuth_rad.clear();
  for (auto& azimuth : sweep.columnAzimuth_rad) azimuth += 0.01f;
  projector.prepare(sweep);
  expectFormula(sweep, projector);
}

TEST(SweepProjector, FewerRowsAndColumnsThanBefore_AreProjected) {
  obs::SweepProjector projector;
  projector.prepare(bigSweep());
  const auto small = test::sampleSweep();
  projector.prepare(*small);
  expectFormula(*small, projector);
}
