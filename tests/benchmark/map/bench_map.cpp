// What the map costs: insertion, a graph update with a walk over all points, and the elevation of line-scans.

#include <benchmark/benchmark.h>

#include <random>

#include "leading_edge_scene.h"
#include "s2s/map/CSeabedSkyMap.h"

namespace {

using namespace s2s;
using core::Isometry;
using core::isometryFromXyzYpr;

std::vector<map::ScanPoint> randomSweep(std::size_t count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> place(-30, 30);
  std::vector<map::ScanPoint> points(count);
  for (auto& p : points) p = {{place(random), place(random), 0.1f * place(random)}, 50, 0.02f};
  return points;
}

void insertSweep(benchmark::State& state) {
  const auto sweep = randomSweep(65536);
  map::CSeabedSkyMap map;
  core::TimeNs time = 0;
  for (auto _ : state) {
    map.insertScan(map::Layer::Lidar, time, isometryFromXyzYpr(1e-9 * static_cast<double>(time), 0, 0, 0, 0, 0), sweep);
    time += 100'000'000;
  }
  state.counters["points/s"] =
      benchmark::Counter(65536.0 * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(insertSweep)->Unit(benchmark::kMillisecond)->Iterations(50);

void graphUpdateAndWalk(benchmark::State& state) {
  map::MapOptions options;
  options.insertion.lidarVoxel_m = 0;
  map::CSeabedSkyMap map(options);
  const auto sweep = randomSweep(20000);
  std::map<std::uint64_t, Isometry> poses;
  for (std::uint64_t i = 0; i < 100; ++i) {
    const auto time = static_cast<core::TimeNs>(i) * core::kNsPerSecond;
    const Isometry T = isometryFromXyzYpr(static_cast<double>(i), 0, 0, 0, 0, 0);
    map.addKeyframe({i, time, T, T});
    map.insertScan(map::Layer::Lidar, time, T, sweep);
    poses[i] = isometryFromXyzYpr(0, 0.1, 0, 0, 0, 0) * T;
  }
  for (auto _ : state) {
    map.setKeyframePoses(poses);
    double sum = 0;
    map.forEachPoint(map::Layer::Lidar, [&sum](const map::MapPoint& p) { sum += p.p_map.z(); });
    benchmark::DoNotOptimize(sum);
  }
  state.counters["points/s"] =
      benchmark::Counter(static_cast<double>(map.pointCount() * static_cast<std::size_t>(state.iterations())),
                         benchmark::Counter::kIsRate);
}
BENCHMARK(graphUpdateAndWalk)->Unit(benchmark::kMillisecond);

/// A horizontal ping of 512 beams, over a seabed that ten seconds of both sonars have told of.
void resolveHorizontalPing(benchmark::State& state) {
  test::LeadingEdgeScene scene;
  scene.add(test::LeadingEdgeScene::seabed(-3.4));
  map::CSeabedSkyMap map;
  for (int i = 0; i < 100; ++i) {
    const Isometry T = isometryFromXyzYpr(0.1 * i, 0, 0, 0, 0, 0);
    map.insertLineScan(map::Layer::LineVertical, i, T,
                       scene.ping(T, test::verticalMount(), test::kVerticalHalfFan, 64));
  }
  const Isometry T = isometryFromXyzYpr(5, 0, 0, 0, 0, 0);
  const auto ping = scene.ping(T, test::horizontalMount(), test::kHorizontalHalfFan, 512);
  for (auto _ : state) benchmark::DoNotOptimize(map.insertLineScan(map::Layer::LineHorizontal, 200, T, ping));
  state.counters["returns/s"] = benchmark::Counter(
      static_cast<double>(ping.returns.size()) * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(resolveHorizontalPing)->Unit(benchmark::kMillisecond);

}  // namespace
