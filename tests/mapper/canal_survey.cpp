#include "canal_survey.h"

#include <algorithm>

#include "s2s/sim/scene_loader.h"

namespace s2s::mapper {

void CanalSurvey::add(const sim::SimulationOptions& options, bool (*wanted)(const mrpt::obs::CObservation&)) {
  auto ini = core::IniFile::load(std::string(S2S_SOURCE_DIR) + "/share/scenes/canal.ini");
  const auto scene = sim::loadScene(ini);
  const sim::SurveySimulator simulator(scene, 1, options);
  sim::SimulationSinks sinks;
  sinks.record = [this, wanted](const mrpt::obs::CObservation::Ptr& record) {
    if (wanted(*record)) records.push_back(record);
  };
  simulator.run(sinks);
  std::stable_sort(records.begin(), records.end(),
                   [](const auto& a, const auto& b) { return a->timestamp < b->timestamp; });
  for (double t_s = 0; t_s <= options.duration_s; t_s += 0.01)
    truth.append(options.startTime + core::durationNs(t_s), simulator.motion().pose(t_s));
}

std::vector<double> CanalSurvey::positionErrors_m(const core::Trajectory& T_map_vehicle) const {
  const core::Isometry T_world_map = *truth.at(T_map_vehicle.front().time) * T_map_vehicle.front().T.inverse();
  std::vector<double> errors_m;
  for (const auto& pose : T_map_vehicle.poses())
    if (const auto T_world_vehicle = truth.at(pose.time))
      errors_m.push_back((T_world_vehicle->translation() - (T_world_map * pose.T).translation()).norm());
  return errors_m;
}

SurveyConfig canalConfig() {
  SurveyConfig config;
  config.odometry.scan.hullBox = {-1.25, -0.65, -0.75, 1.1, 0.65, 1.25};
  return config;
}

}  // namespace s2s::mapper
