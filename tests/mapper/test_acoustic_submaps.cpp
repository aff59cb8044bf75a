#include "s2s/mapper/acoustic_submaps.h"

#include <gtest/gtest.h>

#include "s2s/sonar/ping_geometry.h"

using namespace s2s;
using namespace s2s::mapper;

namespace {

constexpr double kDepth_m = 3;
constexpr double kAperture_rad = 20 * M_PI / 180;

core::Isometry mounting(bool vertical) {
  return core::isometryFromXyzYpr(-1, 0, -0.5, 0, M_PI / 4, vertical ? M_PI / 2 : 0);
}

SonarScan scanAt(map::Layer layer, int step) {
  SonarScan scan;
  scan.layer = layer;
  scan.time = core::durationNs(0.1 * step);
  scan.T_odom_vehicle = core::isometryFromXyzYpr(0.15 * step, 0, 0, 0, 0, 0);
  return scan;
}

/// First echoes of a level seabed, from the lower edge of the aperture.
SonarScan lineScanAt(int step) {
  SonarScan scan = scanAt(map::Layer::LineHorizontal, step);
  scan.T_vehicle_sonar = mounting(false);
  scan.line.verticalAperture_rad = kAperture_rad;
  scan.line.bearingSigma_rad = 0.002;
  for (int degree = -60; degree <= 60; degree += 2) {
    const double bearing_rad = degree * M_PI / 180;
    const Eigen::Vector3d ray_sonar = sonar::pointAt({1, bearing_rad, -kAperture_rad / 2}, scan.line.bearingModel);
    sonar::LineReturn r;
    r.range_m = (-kDepth_m - scan.T_vehicle_sonar.translation().z()) / (scan.T_vehicle_sonar.linear() * ray_sonar).z();
    r.bearing_rad = bearing_rad;
    r.rangeSigma_m = 0.02;
    scan.line.returns.push_back(r);
  }
  return scan;
}

/// An empty ping of the vertical sonar, which tells its aperture.
SonarScan verticalAt(int step) {
  SonarScan scan = scanAt(map::Layer::LineVertical, step);
  scan.T_vehicle_sonar = mounting(true);
  scan.line.verticalAperture_rad = kAperture_rad;
  return scan;
}

SonarScan stereoAt(int step) {
  SonarScan scan = scanAt(map::Layer::Stereo, step);
  for (int n = -3; n <= 3; ++n) scan.points.push_back({{2, 0.2F * static_cast<float>(n), -kDepth_m}, 100, 0.03F});
  return scan;
}

std::vector<graph::AcousticSubmap> submapsOf(int steps, const graph::SonarFactorOptions& options) {
  AcousticSubmaps submaps(options, {});
  std::vector<graph::AcousticSubmap> result;
  for (int step = 0; step < steps; ++step)
    for (const SonarScan& scan : {lineScanAt(step), verticalAt(step), stereoAt(step)})
      if (auto submap = submaps.add(scan)) result.push_back(*submap);
  if (auto submap = submaps.finish()) result.push_back(*submap);
  return result;
}

}  // namespace

TEST(AcousticSubmaps, LevelSeabed_LiesWhereItIs) {
  const auto submaps = submapsOf(100, {});  // 15 m
  ASSERT_GE(submaps.size(), 4U);
  for (const auto& submap : submaps) {
    EXPECT_FALSE(submap.swath_vehicle.empty());
    for (const auto& point : submap.swath_vehicle) {
      EXPECT_NEAR(point.p.z(), -kDepth_m, 0.05);  // the resolver's own accuracy on a level seabed
      EXPECT_GT(point.sigma_m, 0);
      // One degree more of aperture, some metres away, is centimetres.
      EXPECT_GT(point.shared_m.col(0).norm(), 0.03);
      EXPECT_GT(point.shared_m.col(1).norm(), 0.02);
    }
    for (const auto& point : submap.stereo_vehicle) EXPECT_TRUE(point.shared_m.isZero());
  }
}

TEST(AcousticSubmaps, EachStereoPoint_IsInOneSubmapOnly) {
  const int steps = 100;
  std::size_t count = 0;
  for (const auto& submap : submapsOf(steps, {})) count += submap.stereo_vehicle.size();
  // None twice; only a last piece shorter than half a submap may be left out: 1.5 m, 10 pings.
  EXPECT_LE(count, 7U * steps);
  EXPECT_GE(count, 7U * (steps - 11));
}

TEST(AcousticSubmaps, ReturnsOfTheStereoWindow_AreNoPartOfTheSwath) {
  for (const auto& submap : submapsOf(60, {}))
    for (const auto& point : submap.swath_vehicle)
      // 12 degrees of bearing at the 3.1 m to the seabed.
      EXPECT_GT(std::abs(point.p.y()), 3.1 * std::sin(11.9 * M_PI / 180) * 0.95);
}

TEST(AcousticSubmaps, VesselThatLiesStill_GivesNone) {
  AcousticSubmaps submaps({}, {});
  for (int step = 0; step < 400; ++step) {
    SonarScan scan = stereoAt(0);
    scan.time = core::durationNs(0.1 * step);
    EXPECT_FALSE(submaps.add(scan));
  }
  EXPECT_FALSE(submaps.finish());
}

TEST(AcousticSubmaps, SwitchedOff_GivesNone) {
  graph::SonarFactorOptions off;
  off.enabled = false;
  EXPECT_TRUE(submapsOf(60, off).empty());
}
