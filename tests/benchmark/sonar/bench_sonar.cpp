#include <benchmark/benchmark.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

#include "../../sonar/synthetic_pings.h"
#include "s2s/sonar/sonar_stereo.h"

/// Speed of the sonar stages on one core, on a level seabed under both sonars (512 x 700 and 256 x 700 pixels).
namespace {

using namespace s2s;
using namespace s2s::sonar;

struct Scene {
  test::TwinSonars twins;
  obs::CObservationImagingSonar h, v;
  SonarStereo stereo{horizontalDefaults(), devicesForScene()};
  ProcessedPing readyH, readyV;

  Scene() {
    cv::setNumThreads(1);
    const auto seabed = test::levelSeabed(3.0);
    h = twins.horizontalPing(seabed);
    v = twins.verticalPing(seabed);
    readyH = stereo.horizontal().process(h);
    readyV = stereo.vertical().process(v);
  }
  static DeviceOptions devicesForScene() {
    DeviceOptions options = verticalDefaults();
    options.cfar.minIntensity = 80;  // what the synthetic speckle reaches
    return options;
  }
};

const Scene& scene() {
  static const Scene kScene;
  return kScene;
}

void preprocessAndLeadingEdgeHorizontal(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(scene().stereo.horizontal().process(scene().h));
}
BENCHMARK(preprocessAndLeadingEdgeHorizontal)->Unit(benchmark::kMillisecond);

void preprocessAndLeadingEdgeVertical(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(scene().stereo.vertical().process(scene().v));
}
BENCHMARK(preprocessAndLeadingEdgeVertical)->Unit(benchmark::kMillisecond);

void featuresAndStereo(benchmark::State& state) {
  StereoResult result;
  for (auto _ : state) {
    result = scene().stereo.process(scene().readyH, scene().readyV, scene().twins.T_h_v());
    benchmark::DoNotOptimize(result);
  }
  state.counters["features"] = static_cast<double>(result.counts.features_h + result.counts.features_v);
  state.counters["candidates"] = static_cast<double>(result.counts.candidates);
  state.counters["points"] = static_cast<double>(result.points.size());
}
BENCHMARK(featuresAndStereo)->Unit(benchmark::kMillisecond);

void cfar(benchmark::State& state) {
  const CfarDetector detector;
  for (auto _ : state) benchmark::DoNotOptimize(detector.detect(scene().readyH.image));
}
BENCHMARK(cfar)->Unit(benchmark::kMillisecond);

std::vector<Eigen::Vector2d> clusteredPoints(std::size_t count) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> anywhere(0, 8);
  std::vector<Eigen::Vector2d> points;
  while (points.size() < count) {
    const Eigen::Vector2d center(anywhere(random), anywhere(random));
    for (int i = 0; i < 200; ++i)
      points.emplace_back(center.x() + 0.3 * normal(random), center.y() + 0.3 * normal(random));
  }
  points.resize(count);
  return points;
}

void dbscanOnGrid(benchmark::State& state) {
  const auto points = clusteredPoints(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(dbscan(points, {}));
}
BENCHMARK(dbscanOnGrid)->Arg(1000)->Arg(4000)->Arg(16000)->Unit(benchmark::kMillisecond);

/// The peer: neighbours of every point by trying all.
void dbscanNeighboursByBruteForce(benchmark::State& state) {
  const auto points = clusteredPoints(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) {
    std::size_t near = 0;
    for (const auto& a : points)
      for (const auto& b : points) near += (a - b).squaredNorm() <= 0.04 ? 1 : 0;
    benchmark::DoNotOptimize(near);
  }
}
BENCHMARK(dbscanNeighboursByBruteForce)->Arg(1000)->Arg(4000)->Arg(16000)->Unit(benchmark::kMillisecond);

AssignmentProblem localProblem(int size) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> cost(0, 1);
  AssignmentProblem p;
  p.rows = size / 4;
  p.columns = size;
  for (int r = 0; r < p.rows; ++r)
    for (int k = 0; k < 60; ++k) p.edges.push_back({r, std::min(p.columns - 1, 4 * r + k), cost(random)});
  return p;
}

void assignmentOptimal(benchmark::State& state) {
  const auto problem = localProblem(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(assignOptimally(problem));
}
BENCHMARK(assignmentOptimal)->Arg(400)->Arg(4000)->Unit(benchmark::kMillisecond);

void assignmentAuction(benchmark::State& state) {
  const auto problem = localProblem(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(assignByAuction(problem, 0.01));
}
BENCHMARK(assignmentAuction)->Arg(400)->Arg(4000)->Unit(benchmark::kMillisecond);

void triangulationExact(benchmark::State& state) {
  const test::TwinSonars twins;
  const Triangulator triangulator(twins.T_h_v(), obs::BearingModel::Azimuth, obs::BearingModel::Azimuth, 0.35, 0.35);
  const Eigen::Vector3d p(5, 0.4, -0.3);
  const auto h = sonarCoordinates(p, obs::BearingModel::Azimuth);
  const auto v = sonarCoordinates(twins.T_h_v().inverse() * p, obs::BearingModel::Azimuth);
  for (auto _ : state)
    benchmark::DoNotOptimize(triangulator.fuse({h.range_m, h.bearing_rad}, {v.range_m + 0.01, v.bearing_rad}));
}
BENCHMARK(triangulationExact)->Unit(benchmark::kMicrosecond);

/// OpenCV's own kernels for scale.
void openCvOtsu(benchmark::State& state) {
  cv::Mat out;
  for (auto _ : state) benchmark::DoNotOptimize(cv::threshold(scene().readyH.image, out, 0, 255, cv::THRESH_OTSU));
}
BENCHMARK(openCvOtsu)->Unit(benchmark::kMillisecond);

}  // namespace
