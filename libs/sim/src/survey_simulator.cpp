#include "s2s/sim/survey_simulator.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace s2s::sim {

using core::TimeNs;
using mrpt::obs::CObservation;

namespace {

constexpr double kSlice_s = 1.0;

/// Numbers of the records of a sensor that fall into [from, to) of the survey.
struct Schedule {
  double rate_hz, offset_s;
  std::int64_t firstFrom(double t_s) const {
    return std::max<std::int64_t>(0, static_cast<std::int64_t>(std::ceil((t_s - offset_s) * rate_hz - 1e-9)));
  }
  double time_s(std::int64_t number) const { return offset_s + static_cast<double>(number) / rate_hz; }
};

/// One record to be made: by whom and when.
struct Job {
  std::function<CObservation::Ptr(double t_s, TimeNs time, std::uint32_t number)> make;
  double t_s;
  std::uint32_t number;
};

/// A sensor whose records do not depend on each other.
struct ParallelSensor {
  Schedule schedule;
  std::function<CObservation::Ptr(double, TimeNs, std::uint32_t)> make;
  std::uint64_t* count;
  double tail_s;  // how long after its time a record still looks at the world
};

std::vector<CObservation::Ptr> makeAll(const std::vector<Job>& jobs, TimeNs start) {
  std::vector<CObservation::Ptr> records(jobs.size());
  tbb::parallel_for(std::size_t{0}, jobs.size(), [&](std::size_t i) {
    records[i] = jobs[i].make(jobs[i].t_s, start + core::durationNs(jobs[i].t_s), jobs[i].number);
  });
  return records;
}

double pathLength_m(const VesselMotion& motion, double duration_s) {
  double length = 0;
  Eigen::Vector3d last = motion.pose(0).translation();
  for (double t = 0.1; t <= duration_s; t += 0.1) {
    const Eigen::Vector3d p = motion.pose(t).translation();
    length += (p - last).head<2>().norm();
    last = p;
  }
  return length;
}

}  // namespace

SurveySimulator::SurveySimulator(const Scene& scene, int experiment, const SimulationOptions& options)
    : scene_(scene),
      options_(options),
      motion_(scene.experiment(experiment), options.vessel, options.waves, options.seed),
      duration_s_(options.duration_s > 0 ? std::min(options.duration_s, motion_.duration_s()) : motion_.duration_s()) {}

SimulationSummary SurveySimulator::run(const std::function<void(const CObservation::Ptr&)>& sink,
                                       const std::function<void(double)>& progress) const {
  const SimulationOptions& o = options_;
  const RayCaster caster(scene_.objects);
  const LidarModel lidar(o.lidar, o.lidar.T_vehicle_sensor * o.mountingErrors.lidar, scene_, caster,
                         mixBits(o.seed + 11));
  const SonarModel horizontal(o.sonarHorizontal, o.sonarHorizontal.T_vehicle_sensor * o.mountingErrors.sonarHorizontal,
                              scene_, caster, mixBits(o.seed + 12));
  const SonarModel vertical(o.sonarVertical, o.sonarVertical.T_vehicle_sensor * o.mountingErrors.sonarVertical, scene_,
                            caster, mixBits(o.seed + 13));
  ImuModel imu(o.imu, mixBits(o.seed + 14));
  GnssModel gnss(o.gnss, mixBits(o.seed + 15));

  SimulationSummary summary;
  summary.duration_s = duration_s_;
  summary.length_m = pathLength_m(motion_, duration_s_);
  std::vector<ParallelSensor> sensors;
  const auto addSonar = [&](const SonarOptions& s, const SonarModel& model, std::uint64_t& count) {
    if (s.enabled)
      sensors.push_back({{s.rate_hz, s.startOffset_s},
                         [&](double t, TimeNs time, std::uint32_t n) { return model.ping(motion_, t, time, n); },
                         &count,
                         0.05});
  };
  if (o.lidar.enabled)
    sensors.push_back({{o.lidar.rate_hz, 0},
                       [&](double t, TimeNs time, std::uint32_t n) { return lidar.sweep(motion_, t, time, n); },
                       &summary.sweeps,
                       1 / o.lidar.rate_hz});
  addSonar(o.sonarHorizontal, horizontal, summary.pingsHorizontal);
  addSonar(o.sonarVertical, vertical, summary.pingsVertical);

  const Schedule imuSchedule{o.imu.rate_hz, 0}, gnssSchedule{o.gnss.rate_hz, 0.1};
  for (double from = 0; from < duration_s_; from += kSlice_s) {
    const double to = std::min(from + kSlice_s, duration_s_);
    std::vector<Job> jobs;
    for (const ParallelSensor& s : sensors)
      for (auto n = s.schedule.firstFrom(from); s.schedule.time_s(n) < to; ++n) {
        if (s.schedule.time_s(n) + s.tail_s > duration_s_) continue;
        jobs.push_back({s.make, s.schedule.time_s(n), static_cast<std::uint32_t>(n)});
        ++*s.count;
      }
    std::vector<CObservation::Ptr> records = makeAll(jobs, o.startTime);
    for (auto n = imuSchedule.firstFrom(from); imuSchedule.time_s(n) < to; ++n, ++summary.imuSamples) {
      const double t = imuSchedule.time_s(n);
      records.push_back(imu.sample(motion_, t, o.startTime + core::durationNs(t)));
    }
    for (auto n = gnssSchedule.firstFrom(from); o.gnss.enabled && gnssSchedule.time_s(n) < to; ++n, ++summary.fixes) {
      const double t = gnssSchedule.time_s(n);
      records.push_back(gnss.fix(motion_, t, o.startTime + core::durationNs(t)));
    }
    std::stable_sort(records.begin(), records.end(),
                     [](const auto& a, const auto& b) { return a->timestamp < b->timestamp; });
    for (const auto& record : records) sink(record);
    progress(to);
  }
  return summary;
}

}  // namespace s2s::sim
