// A survey graph of 5,000 keyframes and 8,600 constraints, and the parking-garage problem.
#include <benchmark/benchmark.h>

#include <filesystem>

#include "../../graph/fixed_random.h"
#include "s2s/graph/graph_io.h"
#include "s2s/graph/graph_slam.h"

namespace {

using namespace s2s;
using graph::test::diagonalCovariance;
using graph::test::FixedRandom;
using graph::test::perturbed;

constexpr int kKeyframes = 5000;
constexpr int kClosures = 3600;

core::Isometry truthAt(int k) {
  // Laps of a canal of 300 m and back, each lap beside the one before.
  const double lap = 620, s = std::fmod(k, lap);
  const double side = s < 300 ? 0 : 10, along = s < 300 ? s : std::max(0.0, 610 - s);
  return core::isometryFromXyzYpr(along, side + 0.5 * std::floor(k / lap), 0.02 * std::sin(0.1 * k),
                                  s < 300 ? 0.0 : 3.1, 0.01 * std::sin(0.2 * k), 0);
}

/// The whole survey but its last closures.
std::unique_ptr<graph::GraphSlam> makeSurvey(int closures) {
  graph::GraphSlamOptions options;
  options.loops.enabled = false;
  options.optimizeAtCount = 1000000;
  options.optimizeAt_sigma = 1e9;
  auto slam = std::make_unique<graph::GraphSlam>(options);
  FixedRandom random(1);
  core::Isometry T_odom = truthAt(0);
  for (int k = 0; k < kKeyframes; ++k) {
    graph::KeyframeInput input;
    input.time = core::durationNs(1 + k);
    if (k > 0) T_odom = T_odom * perturbed(truthAt(k - 1).inverse() * truthAt(k), random.normal6(0.004, 0.0003));
    input.T_odom_vehicle = T_odom;
    input.motionCovariance = diagonalCovariance(0.004, 0.0003);
    input.gravity = graph::GravityMeasurement{truthAt(k).linear().transpose() * Eigen::Vector3d::UnitZ(), 0.003};
    slam->addKeyframe(input);
  }
  for (int c = 0; c < closures; ++c) {
    const int to = 620 + c * (kKeyframes - 621) / kClosures;
    const int from = to - 620;
    slam->offerClosure(from, to, perturbed(truthAt(from).inverse() * truthAt(to), random.normal6(0.02, 0.001)),
                       diagonalCovariance(0.02, 0.001));
  }
  return slam;
}

/// One more closure at the end of a survey that was optimised before: what a user waits for.
void loopClosureInALargeSurvey(benchmark::State& state) {
  const auto slam = makeSurvey(kClosures - 64);
  slam->optimizeNow();
  FixedRandom random(2);
  int to = kKeyframes - 65;
  for (auto _ : state) {
    state.PauseTiming();
    const int from = to - 620;
    slam->offerClosure(from, to, perturbed(truthAt(from).inverse() * truthAt(to), random.normal6(0.02, 0.001)),
                       diagonalCovariance(0.02, 0.001));
    ++to;
    state.ResumeTiming();
    benchmark::DoNotOptimize(slam->optimizeNow());
  }
  const auto statistics = slam->statistics();
  state.counters["constraints"] = static_cast<double>(slam->poseGraph().constraints.size());
  state.counters["iterations"] = statistics.last.iterations;
}
BENCHMARK(loopClosureInALargeSurvey)->Unit(benchmark::kMillisecond)->Iterations(10);

/// The first optimisation of the same survey, from the odometry's poses.
void largeSurveyFromOdometry(benchmark::State& state) {
  const auto slam = makeSurvey(kClosures);
  const graph::PoseGraph start = slam->poseGraph();
  for (auto _ : state) {
    graph::PoseGraph graph = start;
    const auto summary = graph::optimize(graph);
    state.counters["iterations"] = summary.iterations;
    state.counters["cost"] = summary.finalCost;
  }
}
BENCHMARK(largeSurveyFromOdometry)->Unit(benchmark::kMillisecond);

void parkingGarage(benchmark::State& state) {
  const std::string path = std::string(S2S_DATA_DIR) + "/posegraph/parking-garage.g2o";
  if (!std::filesystem::exists(path)) {
    state.SkipWithError(("no data at " + path).c_str());
    return;
  }
  const graph::PoseGraph start = graph::readGraph(path).graph;
  for (auto _ : state) {
    graph::PoseGraph graph = start;
    const auto summary = graph::optimize(graph);
    state.counters["iterations"] = summary.iterations;
    state.counters["cost"] = summary.finalCost;
  }
}
BENCHMARK(parkingGarage)->Unit(benchmark::kMillisecond);

void marginalCovarianceInALargeSurvey(benchmark::State& state) {
  const auto slam = makeSurvey(kClosures);
  slam->optimizeNow();
  slam->marginalCovariance(0);
  int k = 1;
  for (auto _ : state) benchmark::DoNotOptimize(slam->marginalCovariance(k++ % kKeyframes));
}
BENCHMARK(marginalCovarianceInALargeSurvey)->Unit(benchmark::kMillisecond);

}  // namespace
