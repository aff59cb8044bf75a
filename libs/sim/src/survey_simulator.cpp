#include "s2s/sim/survey_simulator.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace s2s::sim {

using core::TimeNs;
using mrpt::obs::CObservation;

namespace {

constexpr double kSlice_s = 1.0;

double pathLength_m(const VesselMotion& motion, double duration_s) {
  double length = 0;
  Eigen::Vector3d last = motion.pose(0).translation();
  for (int i = 1; 0.1 * i <= duration_s; ++i) {
    const Eigen::Vector3d p = motion.pose(0.1 * i).translation();
    length += (p - last).head<2>().norm();
    last = p;
  }
  return length;
}

/// Each sonar hears the other, so it must know when that one transmits.
void introduceSonars(SimulationOptions& o) {
  const auto introduce = [](SonarOptions& a, const SonarOptions& b) {
    a.artefacts.otherRate_hz = b.enabled ? b.rate_hz : 0;
    a.artefacts.otherOffset_s = b.startOffset_s;
  };
  introduce(o.sonarHorizontal, o.sonarVertical);
  introduce(o.sonarVertical, o.sonarHorizontal);
}

}  // namespace

struct SurveySimulator::Models {
  Models(const Scene& scene, const SimulationOptions& o)
      : caster(scene.objects),
        lidar(o.lidar, o.lidar.T_vehicle_sensor * o.mountingErrors.lidar, scene, caster, mixBits(o.seed + 11)),
        horizontal(o.sonarHorizontal, o.sonarHorizontal.T_vehicle_sensor * o.mountingErrors.sonarHorizontal, scene,
                   caster, mixBits(o.seed + 12)),
        vertical(o.sonarVertical, o.sonarVertical.T_vehicle_sensor * o.mountingErrors.sonarVertical, scene, caster,
                 mixBits(o.seed + 13)),
        imu(o.imu, mixBits(o.seed + 14)),
        gnss(o.gnss, mixBits(o.seed + 15)) {}

  RayCaster caster;
  LidarModel lidar;
  SonarModel horizontal, vertical;
  ImuModel imu;
  GnssModel gnss;
};

/// One record on its way to the sinks.
struct SurveySimulator::Record {
  const Sensor* sensor = nullptr;
  double t_s = 0;
  std::uint32_t number = 0;
  CObservation::Ptr observation;
  PingTruth truth;
};

/// A sensor's schedule and how it makes a record.
struct SurveySimulator::Sensor {
  std::uint64_t id;
  double rate_hz, offset_s;
  double tail_s;    // how long after its time a record still looks at the world
  bool sequential;  // records depend on the ones before (IMU, GNSS)
  SensorFaults faults;
  std::function<CObservation::Ptr(double t_s, TimeNs time, std::uint32_t number, PingTruth& truth)> make;
  std::function<void(const PingTruth&)> truthSink;
  std::uint64_t* count;

  std::int64_t firstFrom(double t_s) const {
    return std::max<std::int64_t>(0, static_cast<std::int64_t>(std::ceil((t_s - offset_s) * rate_hz - 1e-9)));
  }
  double time_s(std::int64_t number) const { return offset_s + static_cast<double>(number) / rate_hz; }
};

SurveySimulator::SurveySimulator(const Scene& scene, int experiment, const SimulationOptions& options)
    : scene_(scene),
      options_(options),
      motion_(scene.experiment(experiment), options.vessel, options.waves, options.seed),
      faults_(options.faults, mixBits(options.seed + 16)),
      duration_s_(options.duration_s > 0 ? std::min(options.duration_s, motion_.duration_s()) : motion_.duration_s()) {
  introduceSonars(options_);
}

std::vector<SurveySimulator::Sensor> SurveySimulator::sensors(Models& models, const SimulationSinks& sinks,
                                                              SimulationSummary& summary) const {
  const SimulationOptions& o = options_;
  const FaultOptions& f = o.faults;
  std::vector<Sensor> all;
  if (o.lidar.enabled)
    all.push_back(
        {1,
         o.lidar.rate_hz,
         0,
         1 / o.lidar.rate_hz,
         false,
         f.lidar,
         [&](double t, TimeNs time, std::uint32_t n, PingTruth&) { return models.lidar.sweep(motion_, t, time, n); },
         {},
         &summary.sweeps});
  const auto addSonar = [&](std::uint64_t id, const SonarOptions& s, const SonarModel& model,
                            const SensorFaults& faults, const std::function<void(const PingTruth&)>& sink,
                            std::uint64_t& count) {
    if (!s.enabled) return;
    const bool wantsTruth = static_cast<bool>(sink);
    all.push_back({id, s.rate_hz, s.startOffset_s, 0.05, false, faults,
                   [this, &model, wantsTruth](double t, TimeNs time, std::uint32_t n, PingTruth& truth) {
                     return model.ping(motion_, t, time, n, wantsTruth ? &truth : nullptr);
                   },
                   sink, &count});
  };
  addSonar(2, o.sonarHorizontal, models.horizontal, f.sonarHorizontal, sinks.returnsHorizontal,
           summary.pingsHorizontal);
  addSonar(3, o.sonarVertical, models.vertical, f.sonarVertical, sinks.returnsVertical, summary.pingsVertical);
  all.push_back({4,
                 o.imu.rate_hz,
                 0,
                 0,
                 true,
                 f.imu,
                 [&](double t, TimeNs time, std::uint32_t, PingTruth&) { return models.imu.sample(motion_, t, time); },
                 {},
                 &summary.imuSamples});
  if (o.gnss.enabled)
    all.push_back({5,
                   o.gnss.rate_hz,
                   0.1,
                   0,
                   true,
                   f.gnss,
                   [&](double t, TimeNs time, std::uint32_t, PingTruth&) {
                     const double drift_m = f.spoofDrift_mps * std::max(0.0, t - f.spoofFrom_s);
                     return models.gnss.fix(
                         motion_, t, time,
                         {drift_m * std::cos(f.spoofDirection_rad), drift_m * std::sin(f.spoofDirection_rad), 0});
                   },
                   {},
                   &summary.fixes});
  return all;
}

std::vector<SurveySimulator::Record> SurveySimulator::simulateSlice(const std::vector<Sensor>& sensors, double from_s,
                                                                    double to_s) const {
  std::vector<Record> records;
  const auto make = [this](Record& r) {
    const TimeNs time = options_.startTime + core::durationNs(r.t_s);
    r.observation = r.sensor->make(r.t_s, time, r.number, r.truth);
    const TimeNs error = faults_.timeError(r.sensor->faults, r.sensor->id, r.number, r.t_s);
    if (error != 0) r.observation->timestamp = core::toMrptTime(time + error);
  };
  for (const Sensor& s : sensors)
    for (auto n = s.firstFrom(from_s); s.time_s(n) < to_s; ++n) {
      if (s.time_s(n) + s.tail_s > duration_s_) continue;
      Record r{&s, s.time_s(n), static_cast<std::uint32_t>(n), {}, {}};
      if (s.sequential) make(r);  // made even if it gets lost, as the next ones depend on it
      if (faults_.delivers(s.faults, s.id, r.number, r.t_s)) records.push_back(std::move(r));
    }
  tbb::parallel_for(std::size_t{0}, records.size(), [&](std::size_t i) {
    if (!records[i].observation) make(records[i]);
  });
  std::stable_sort(records.begin(), records.end(), [](const Record& a, const Record& b) { return a.t_s < b.t_s; });
  return records;
}

SimulationSummary SurveySimulator::run(const SimulationSinks& sinks) const {
  SimulationSummary summary;
  summary.duration_s = duration_s_;
  summary.length_m = pathLength_m(motion_, duration_s_);
  Models models(scene_, options_);
  const std::vector<Sensor> all = sensors(models, sinks, summary);
  for (int slice = 0; slice * kSlice_s < duration_s_; ++slice) {
    const double from = slice * kSlice_s;
    const double to = std::min(from + kSlice_s, duration_s_);
    for (const Record& r : simulateSlice(all, from, to)) {
      ++*r.sensor->count;
      if (sinks.record) sinks.record(r.observation);
      if (r.sensor->truthSink) r.sensor->truthSink(r.truth);
    }
    if (sinks.progress) sinks.progress(to);
  }
  return summary;
}

}  // namespace s2s::sim
