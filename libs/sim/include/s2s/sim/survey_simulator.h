#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "s2s/obs/rawlog_writer.h"
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
};

/// What was simulated.
struct SimulationSummary {
  double duration_s = 0, length_m = 0;
  std::uint64_t sweeps = 0, pingsHorizontal = 0, pingsVertical = 0, imuSamples = 0, fixes = 0;
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

  /// Gives every record to `sink`, sorted within a slice of one second, and tells the time reached to `progress`.
  SimulationSummary run(const std::function<void(const mrpt::obs::CObservation::Ptr&)>& sink,
                        const std::function<void(double)>& progress) const;

 private:
  const Scene& scene_;
  SimulationOptions options_;
  VesselMotion motion_;
  double duration_s_;
};

}  // namespace s2s::sim
