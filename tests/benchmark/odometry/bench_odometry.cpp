#include <benchmark/benchmark.h>

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
    for (int i = 0; i < kSweeps; ++i)
      made.push_back(sweepAt(canal(), cruise(1.3, 0, 0), 0.05 * i, fullLidar(), random));
    return made;
  }();
  return all;
}

/// One pass over all sweeps with 100 Hz IMU; time is given per sweep.
void odometryOfSweeps(benchmark::State& state) {
  const auto path = cruise(1.3, 0, 0);
  sweeps();
  for (auto _ : state) {
    Random random(2);
    OdometryOptions options;
    ScanMaker maker(options.scan);
    LidarInertialOdometry odometry(options);
    for (int i = 0; i <= 100 * kSweeps / 20; ++i)
      odometry.addImu(imuAt(path, 0.01 * i, core::isometryFromXyzYpr(0, 0, 1, 0, 0, 0), {0.002, 0.02, {}, {}}, random));
    for (const auto& sweep : sweeps()) {
      odometry.addScan(maker.fromSweep(sweep));
      while (auto result = odometry.next()) benchmark::DoNotOptimize(result->T_odom_vehicle);
    }
    odometry.finish();
    while (auto result = odometry.next()) benchmark::DoNotOptimize(result->T_odom_vehicle);
  }
  state.counters["per_sweep"] =
      benchmark::Counter(kSweeps, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
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
