#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "s2s/sim/faults.h"
#include "s2s/sim/gnss_model.h"
#include "s2s/sim/imu_model.h"
#include "s2s/sim/lidar_model.h"
#include "s2s/sim/sonar_model.h"

namespace s2s::sim {

/// How the true mountings differ from the nominal ones that the survey's records and configuration carry:
/// T_true = T_nominal * error.
struct MountingErrors {
  core::Isometry lidar = core::Isometry::Identity(), sonarHorizontal = core::Isometry::Identity(),
                 sonarVertical = core::Isometry::Identity();
};

/// Everything about a simulated survey but the scene.
struct SimulationOptions {
  core::TimeNs startTime = 1'733'400'000'000'000'000;  ///< of the first record: 2024-12-05 12:00 UTC
  std::uint64_t seed = 1;
  double duration_s = 0;  ///< 0: the whole experiment
  VesselOptions vessel;
  WaveOptions waves;
  LidarOptions lidar;
  ImuOptions imu;
  SonarOptions sonarHorizontal, sonarVertical = verticalSonarDefaults();
  GnssOptions gnss;
  MountingErrors mountingErrors;
  FaultOptions faults;
};

/// What was simulated.
struct SimulationSummary {
  double duration_s = 0, length_m = 0;
  std::uint64_t sweeps = 0, pingsHorizontal = 0, pingsVertical = 0, imuSamples = 0, fixes = 0;
};

/// Who gets what is simulated, always called from the thread that called `run`. Empty functions are left out.
struct SimulationSinks {
  std::function<void(const mrpt::obs::CObservation::Ptr&)> record;
  std::function<void(const PingTruth&)> returnsHorizontal, returnsVertical;
  std::function<void(double t_s)> progress;
};

/// Runs one experiment in a scene through all sensor models, in time order and with bounded memory.
///
/// Sweeps and pings are made in parallel, a slice of the survey at a time; each depends only on the seed and its own
/// number, so the bytes are the same for any number of threads.
class SurveySimulator {
 public:
  /// `scene` must outlive the simulator.
  /// @throws core::ConfigError if the scene has no such experiment
  SurveySimulator(const Scene& scene, int experiment, const SimulationOptions& options);

  const VesselMotion& motion() const { return motion_; }
  double duration_s() const { return duration_s_; }

  /// Gives every record to `sinks.record`, sorted by recorded time within a slice of one second.
  SimulationSummary run(const SimulationSinks& sinks) const;

 private:
  struct Models;
  struct Sensor;
  struct Record;
  std::vector<Sensor> sensors(Models& models, const SimulationSinks& sinks, SimulationSummary& summary) const;
  std::vector<Record> simulateSlice(const std::vector<Sensor>& sensors, double from_s, double to_s) const;

  const Scene& scene_;
  SimulationOptions options_;
  VesselMotion motion_;
  FaultInjector faults_;
  double duration_s_;
};

}  // namespace s2s::sim
