#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>

#include "s2s/odometry/deskew.h"
#include "s2s/odometry/lidar_inertial_odometry.h"
#include "s2s/odometry/scan_maker.h"
#include "synthetic.h"

/// Odometry of a vessel in a synthetic canal with a 128 x 1024 LiDAR: 131,072 pixels a sweep.
namespace s2s::odometry {
namespace {

using namespace synthetic;

constexpr int kSweeps = 60;

Lidar fullLidar() {
  Lidar lidar;
  lidar.rows = 128;
  lidar.columns = 1024;
  lidar.period_s = 0.05;
  return lidar;
}

const std::vector<obs::CObservationLidarSweep>& sweeps() {
  static const auto all = [] {
    Random random(1);
    std::vector<obs::CObservationLidarSweep> made;
    made.reserve(kSweeps);
    for (int i = 0; i < kSweeps; ++i)
      made.push_back(sweepAt(canal(), cruise(1.3, 0, 0), 0.05 * i, fullLidar(), random));
    return made;
  }();
  return all;
}

double processorSeconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// One pass over all sweeps with 100 Hz IMU, as they come. The counters are processor time of single sweeps [s], point
/// selection included, after the start, which looks at its sweeps twice.
void odometryOfSweeps(benchmark::State& state) {
  const auto path = cruise(1.3, 0, 0);
  sweeps();
  std::vector<double> seconds;
  for (auto _ : state) {
    Random random(2);
    OdometryOptions options;
    options.initialisation_s = 0.5;
    ScanMaker maker(options.scan);
    LidarInertialOdometry odometry(options);
    for (int i = 0; i < kSweeps; ++i) {
      const double start = processorSeconds();
      odometry.addScan(maker.fromSweep(sweeps()[i]));
      for (int k = 5 * i; k <= 5 * (i + 1); ++k)
        odometry.addImu(
            imuAt(path, 0.01 * k, core::isometryFromXyzYpr(0, 0, 1, 0, 0, 0), {0.002, 0.02, {}, {}}, random));
      while (auto result = odometry.next()) benchmark::DoNotOptimize(result->T_odom_vehicle);
      if (i > kSweeps / 3) seconds.push_back(processorSeconds() - start);
    }
  }
  std::sort(seconds.begin(), seconds.end());
  state.counters["median"] = seconds[seconds.size() / 2];
  state.counters["p95"] = seconds[seconds.size() * 95 / 100];
}
BENCHMARK(odometryOfSweeps)->Unit(benchmark::kMillisecond);

/// Choosing and converting the points of one sweep.
void scanOfSweep(benchmark::State& state) {
  ScanMaker maker{ScanOptions()};
  for (auto _ : state) benchmark::DoNotOptimize(maker.fromSweep(sweeps().front()).points_sensor.data());
}
BENCHMARK(scanOfSweep)->Unit(benchmark::kMillisecond);

/// All points of a sweep for a keyframe.
void deskewOfFullSweep(benchmark::State& state) {
  core::Trajectory trajectory;
  for (int i = 0; i <= 10; ++i) trajectory.append(timeOf(0.01 * i), cruise(1.3, 0, 0)(0.01 * i));
  for (auto _ : state)
    benchmark::DoNotOptimize(deskewSweep(sweeps().front(), trajectory, timeOf(0.05), {}).points_vehicle.data());
}
BENCHMARK(deskewOfFullSweep)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace s2s::odometry
