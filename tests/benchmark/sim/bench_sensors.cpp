#include <benchmark/benchmark.h>

#include "s2s/sim/options_table.h"
#include "s2s/sim/scene_loader.h"
#include "s2s/sim/survey_simulator.h"

using namespace s2s;

namespace {

/// The shipped canal with experiment 1, as simulate-survey sees it.
struct Canal {
  Canal() {
    core::IniFile ini = core::IniFile::load(S2S_SOURCE_DIR "/share/scenes/canal.ini");
    sim::loadSimulationOptions(ini, options);
    scene = sim::loadScene(ini);
    caster = std::make_unique<sim::RayCaster>(scene.objects);
    motion = std::make_unique<sim::VesselMotion>(scene.experiment(1), options.vessel, options.waves, 1);
  }
  sim::SimulationOptions options;
  sim::Scene scene;
  std::unique_ptr<sim::RayCaster> caster;
  std::unique_ptr<sim::VesselMotion> motion;
};

const Canal& canal() {
  static const Canal kCanal;
  return kCanal;
}

void pingOf(benchmark::State& state, const sim::SonarOptions& options) {
  const sim::SonarModel sonar(options, options.T_vehicle_sensor, canal().scene, *canal().caster, 1);
  std::uint32_t number = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(sonar.ping(*canal().motion, 20 + 0.1 * (number % 100), 0, number));
    ++number;
  }
}

void horizontalPing(benchmark::State& state) { pingOf(state, canal().options.sonarHorizontal); }
void verticalPing(benchmark::State& state) { pingOf(state, canal().options.sonarVertical); }

void lidarSweep(benchmark::State& state) {
  sim::LidarOptions options = canal().options.lidar;
  options.rows = static_cast<int>(state.range(0));
  const sim::LidarModel lidar(options, options.T_vehicle_sensor, canal().scene, *canal().caster, 1);
  std::uint32_t number = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(lidar.sweep(*canal().motion, 20 + 0.1 * (number % 100), 0, number));
    ++number;
  }
}

/// The canal survey with all its sensors, LiDAR rows and sweep rate as given; the counter is survey time over wall
/// time.
void survey(benchmark::State& state) {
  constexpr double kSurvey_s = 6;
  sim::SimulationOptions options = canal().options;
  options.duration_s = kSurvey_s;
  options.lidar.rows = static_cast<int>(state.range(0));
  options.lidar.rate_hz = static_cast<double>(state.range(1));
  const sim::SurveySimulator simulator(canal().scene, 1, options);
  for (auto _ : state) benchmark::DoNotOptimize(simulator.run({}));
  state.counters["x_real_time"] =
      benchmark::Counter(kSurvey_s * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

}  // namespace

BENCHMARK(horizontalPing)->Unit(benchmark::kMillisecond);
BENCHMARK(verticalPing)->Unit(benchmark::kMillisecond);
BENCHMARK(lidarSweep)->Arg(64)->Arg(128)->Unit(benchmark::kMillisecond);
BENCHMARK(survey)->Args({64, 10})->Args({128, 20})->Unit(benchmark::kSecond)->UseRealTime();
