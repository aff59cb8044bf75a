#include <gtest/gtest.h>

#include "s2s/core/error.h"
#include "s2s/obs/sweep_projector.h"
#include "s2s/sim/lidar_model.h"
#include "sim_support.h"

using namespace s2s;
using namespace s2s::test;
using Eigen::Vector3d;

namespace {

sim::LidarEffects noEffects() {
  sim::LidarEffects e;
  e.noise = e.bias = e.dropouts = e.mixedPixels = e.ownVessel = e.waterReturns = e.waterGhosts = false;
  return e;
}

sim::VesselMotion movingVessel() {
  sim::Experiment e;
  e.waypoints_m = {{-5, -3}, {4, 2}, {-4, 4}};
  e.speed_mps = 1.5;
  sim::WaveOptions waves;
  waves.significantHeight_m = 0.2;
  return {e, {}, waves, 4};
}

constexpr double kSizeX = 24, kSizeY = 18, kTop = 9;

/// A hall on the water: walls and a ceiling.
sim::Scene hall() { return sceneOf({moved(sim::makeBox({kSizeX, kSizeY, 2 * kTop}), 0, 0, 0)}); }

double distanceToHall(const Vector3d& p) {
  return std::min({std::abs(std::abs(p.x()) - kSizeX / 2), std::abs(std::abs(p.y()) - kSizeY / 2),
                   std::abs(std::abs(p.z()) - kTop)});
}

}  // namespace

TEST(LidarModel, NoiseFreeSweep_LiesOnTheMeshAfterDeskewWithTruePoses) {
  sim::LidarOptions o;
  o.effects = noEffects();
  const sim::Scene scene = hall();
  const sim::RayCaster caster(scene.objects);
  const sim::LidarModel lidar(o, o.T_vehicle_sensor, scene, caster, 1);
  const sim::VesselMotion motion = movingVessel();
  const double t = 6;  // under way, turning and rolling
  const auto sweep = lidar.sweep(motion, t, 0, 0);
  sweep->checkConsistent();
  obs::SweepProjector projector;
  projector.prepare(*sweep);
  std::size_t points = 0;
  double worst_m = 0;
  for (std::size_t row = 0; row < sweep->rowCount; ++row)
    for (std::size_t column = 0; column < sweep->columnCount; ++column) {
      const auto range = sweep->echoes[0].range[row * sweep->columnCount + column];
      if (range == 0) continue;
      const auto T_world_sensor = motion.pose(t + 1e-9 * sweep->pixelTime_ns(row, column)) * o.T_vehicle_sensor;
      worst_m = std::max(worst_m, distanceToHall(T_world_sensor * projector.point(row, column, range).cast<double>()));
      ++points;
    }
  EXPECT_GT(points, 20000u);
  EXPECT_LT(worst_m, 0.001);  // the promise: 1 mm; ranges are counted in millimetres
}

TEST(LidarModel, WaterWithoutEffects_GivesNothing) {
  sim::LidarOptions o;
  o.effects = noEffects();
  const sim::Scene scene = sceneOf({makeFloor(-2, 100)});  // a seabed that light must not find
  const sim::RayCaster caster(scene.objects);
  const sim::LidarModel lidar(o, o.T_vehicle_sensor, scene, caster, 1);
  EXPECT_EQ(lidar.sweep(movingVessel(), 5, 0, 0)->returnCount(), 0u);
}

TEST(LidarModel, WaterEffects_GiveSparseReturnsNearTheSurfaceAndGhostsBelow) {
  sim::LidarOptions o;
  o.effects = noEffects();
  o.effects.waterReturns = o.effects.waterGhosts = true;
  const sim::Scene scene = hall();
  const sim::RayCaster caster(scene.objects);
  const sim::LidarModel lidar(o, o.T_vehicle_sensor, scene, caster, 1);
  const sim::VesselMotion motion = movingVessel();
  const auto sweep = lidar.sweep(motion, 5, 0, 0);
  obs::SweepProjector projector;
  projector.prepare(*sweep);
  int surface = 0, below = 0;
  for (std::size_t row = 0; row < sweep->rowCount; ++row)
    for (std::size_t column = 0; column < sweep->columnCount; ++column) {
      const auto range = sweep->echoes[0].range[row * sweep->columnCount + column];
      if (range == 0) continue;
      const auto T = motion.pose(5 + 1e-9 * sweep->pixelTime_ns(row, column)) * o.T_vehicle_sensor;
      const Vector3d p = T * projector.point(row, column, range).cast<double>();
      if (p.z() > -0.15 && p.z() < 0.15) ++surface;
      if (p.z() < -0.3) {
        ++below;  // a ghost is the mirror image of the hall, which is symmetric to the surface
        EXPECT_LT(distanceToHall(p), 0.002);
      }
    }
  EXPECT_GT(surface, 50);
  EXPECT_GT(below, 50);
  EXPECT_LT(below, 5000);
}

TEST(LidarModel, OwnVessel_HidesWhatIsBehindIt) {
  sim::LidarOptions o;
  o.effects = noEffects();
  o.effects.ownVessel = true;
  sim::Scene scene = hall();
  scene.vesselParts.push_back({"post", sim::ObjectKind::Vessel, 0, moved(sim::makeBox({0.1, 0.1, 3}), -1.2, 0, 0)});
  const sim::RayCaster caster(scene.objects);
  const sim::LidarModel lidar(o, o.T_vehicle_sensor, scene, caster, 1);
  const auto sweep = lidar.sweep(movingVessel(), 5, 0, 0);
  const double nearest = *std::min_element(sweep->echoes[0].range.begin(), sweep->echoes[0].range.end(),
                                           [](auto a, auto b) { return (a ? a : ~0u) < (b ? b : ~0u); });
  EXPECT_NEAR(nearest * sweep->rangeResolution_m, 1.15 + 0.22, 0.02);
}

TEST(LidarEffects, RangeNoise_HasItsStandardDeviation) {
  sim::LidarEffects e = noEffects();
  e.noise = true;
  e.rangeSigma_m = 0.02;
  e.rangeSigmaFar_mPerM = 0.001;
  sim::Random random(1);
  double sum = 0, squares = 0;
  constexpr int kCount = 20000;
  for (int i = 0; i < kCount; ++i) {
    const double error = sim::detectedRange_m({10, 1, 1}, e, random) - 10;
    sum += error;
    squares += error * error;
  }
  EXPECT_NEAR(sum / kCount, 0, 4 * 0.03 / std::sqrt(kCount));
  EXPECT_NEAR(std::sqrt(squares / kCount), 0.03, 0.03 * 0.02);  // four standard deviations of the estimate
}

TEST(LidarEffects, Dropouts_TakeHalfAtTheHalfRange_AndSpareRetroTargets) {
  sim::LidarEffects e = noEffects();
  e.dropouts = true;
  sim::Random random(1);
  int white = 0, retro = 0;
  constexpr int kCount = 10000;
  for (int i = 0; i < kCount; ++i) {
    white += sim::detectedRange_m({e.halfRange_m, 1, 1}, e, random) > 0;
    retro += sim::detectedRange_m({e.halfRange_m, 20, 1}, e, random) > 0;
  }
  EXPECT_NEAR(white / double(kCount), 0.5, 0.02);  // four binomial standard deviations
  EXPECT_EQ(retro, kCount);
}

TEST(LidarEffects, Bias_GrowsWithIncidenceAndDarkness) {
  sim::LidarEffects e = noEffects();
  e.bias = true;
  sim::Random random(1);
  EXPECT_NEAR(sim::detectedRange_m({10, 1, 1}, e, random), 10, 1e-12);
  EXPECT_NEAR(sim::detectedRange_m({10, 1, 0.5}, e, random), 10 + e.incidenceBias_m, 1e-12);
  EXPECT_GT(sim::detectedRange_m({10, 0.2, 1}, e, random), 10);
}

TEST(LidarEffects, MixedPixel_LiesBetweenItsSurfacesNearerToItsOwn_OnlyAtEdges) {
  const sim::LidarEffects e = noEffects();
  sim::Random random(1);
  double sum_m = 0;
  for (int i = 0; i < 1000; ++i) {
    sim::LidarEcho smooth{10, 0.5, 1}, edge{10, 0.5, 1}, far{10, 0.5, 1};
    sim::mixPixel(smooth, {10.05, 0.5, 1}, e, random);
    sim::mixPixel(edge, {11, 0.5, 1}, e, random);
    sim::mixPixel(far, {14, 0.5, 1}, e, random);
    EXPECT_EQ(smooth.range_m, 10);
    EXPECT_EQ(far.range_m, 10);  // too far apart to merge
    EXPECT_GE(edge.range_m, 10);
    EXPECT_LE(edge.range_m, 10.5);
    sum_m += edge.range_m / 1000;
  }
  // Shares of 0 to a half of 1 m, uniform: 0.25 m with a standard error of 0.5 / sqrt(12 * 1000).
  EXPECT_NEAR(sum_m, 10.25, 4 * 0.0046);
}

TEST(LidarModel, MixedPixels_AreAsManyAsFootprintsOnEdges_AndNoneOnPlainWalls) {
  sim::LidarOptions o;
  o.effects = noEffects();
  o.effects.mixedPixels = true;
  const sim::VesselMotion motion = movingVessel();
  constexpr int kSweeps = 10;
  constexpr double kBoardX = 11.2, kBoardWidth = 2.0;
  const auto run = [&](const sim::Scene& scene, const auto& visit) {
    const sim::RayCaster caster(scene.objects);
    const sim::LidarModel lidar(o, o.T_vehicle_sensor, scene, caster, 1);
    for (int i = 0; i < kSweeps; ++i) {
      const auto sweep = lidar.sweep(motion, i, 0, static_cast<std::uint32_t>(i));
      obs::SweepProjector projector;
      projector.prepare(*sweep);
      for (std::size_t row = 0; row < sweep->rowCount; ++row)
        for (std::size_t column = 0; column < sweep->columnCount; ++column) {
          const auto range = sweep->echoes[0].range[row * sweep->columnCount + column];
          if (range == 0) continue;
          const auto T_world_sensor = motion.pose(i + 1e-9 * sweep->pixelTime_ns(row, column)) * o.T_vehicle_sensor;
          visit(Vector3d(T_world_sensor * projector.point(row, column, range).cast<double>()));
        }
    }
  };
  // Walls seen at all angles: the rows of a column look some degrees apart, which must not make edges.
  run(hall(), [](const Vector3d& p) { EXPECT_LT(distanceToHall(p), 2e-3); });

  // A board from top to bottom 0.8 m in front of a wall: two upright edges.
  const sim::Scene board = sceneOf({moved(sim::makeBox({kSizeX, kSizeY, 2 * kTop}), 0, 0, 0),
                                    moved(sim::makeBox({0.02, kBoardWidth, 2 * kTop}), kBoardX, 0, 0)});
  double mixed = 0, atEdges = 0;
  const double spacing_rad = 2 * M_PI / o.columns;
  run(board, [&](const Vector3d& p) {
    const bool onBoard = std::abs(p.x() - kBoardX) < 0.03 && std::abs(p.y()) < kBoardWidth / 2 + 0.03;
    // Each row meets the board with its width over the columns' spacing at that range: so this counts rows at edges.
    const Vector3d eye = motion.pose(0.5 * kSweeps).translation();
    if (onBoard) atEdges += 2 * spacing_rad * (p - eye).head<2>().norm() / kBoardWidth;
    mixed += !onBoard && distanceToHall(p) > 0.03;
  });
  // Mixed by less than 3 cm of 0.8 m counts as clean, which 8 % are. The eye's place above is a mean, the board is seen
  // up to 30 degrees obliquely, and 700 edges are a sample: 20 %.
  const double expected = 0.92 * o.effects.beamDivergence_rad / spacing_rad;
  EXPECT_NEAR(mixed / atEdges, expected, 0.2 * expected);
}

TEST(LidarEffects, Fresnel_HasItsKnownValues) {
  EXPECT_NEAR(sim::fresnelReflectance(1), 0.0201, 2e-4);  // ((n - 1) / (n + 1))^2
  EXPECT_NEAR(sim::fresnelReflectance(0), 1, 1e-12);
  const double brewster = std::atan(1.33);  // only s-polarised light is reflected
  const double cosIn = std::cos(brewster), cosOut = std::sin(brewster);
  const double s = (cosIn - 1.33 * cosOut) / (cosIn + 1.33 * cosOut);
  EXPECT_NEAR(sim::fresnelReflectance(cosIn), 0.5 * s * s, 1e-9);
}

TEST(LidarMode, Text_IsParsedStrictly) {
  sim::LidarOptions o;
  sim::parseLidarMode("128x2048@20", o);
  EXPECT_EQ(o.rows, 128);
  EXPECT_EQ(o.columns, 2048);
  EXPECT_EQ(o.rate_hz, 20);
  for (const char* bad : {"", "128", "128x1024", "128x1024@", "128x1024@10x", "0x1024@10", "64x1024@-1"})
    EXPECT_THROW(sim::parseLidarMode(bad, o), core::ConfigError) << bad;
}
