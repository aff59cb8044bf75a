#pragma once

#include <mrpt/obs/CObservation.h>
#include <mrpt/system/CTimeLogger.h>

#include <string>
#include <utility>

#include "s2s/mapper/backend_stage.h"
#include "s2s/mapper/fault_log.h"
#include "s2s/mapper/latency_monitor.h"
#include "s2s/mapper/odometry_stage.h"
#include "s2s/mapper/sensor_router.h"
#include "s2s/mapper/sonar_stage.h"
#include "s2s/mapper/survey_config.h"
#include "s2s/mapper/worker.h"

namespace s2s::mapper {

/// The whole pipeline: push observations in order of time, finish, take poses and the map.
///
///     SurveyMapper mapper(config, threads);
///     while (auto observation = reader.next()) mapper.push(observation, reader.where());
///     mapper.finish();
///     mapper.map(); mapper.trajectory(); ...
///
/// Stages: odometry -> (sonar, back end), sonar -> back end; the odometry waits for the images of the sonar stage,
/// which never waits for it. With one thread they run inside `push`, and the same observations give the same map bit
/// for bit. With more, each stage has a thread of its own behind a bounded queue; a fast reader then waits, nothing is
/// dropped. In real time nobody can wait: sweeps and pings that meet a full queue are dropped and counted among the
/// faults, and latencies are measured.
class SurveyMapper {
 public:
  /// @throws core::ConfigError if the configuration contradicts itself
  /// @param prior a map made before, in whose frame the new one shall stand once its place in it is found
  SurveyMapper(const SurveyConfig& config, int threads, bool realtime = false,
               std::unique_ptr<graph::PriorMap> prior = nullptr);
  ~SurveyMapper();

  /// @param where place of the record, for the fault log
  void push(const mrpt::obs::CObservation::Ptr& observation, const std::string& where);
  /// Processes what waits, optimises and settles the map. No `push` afterwards.
  void finish();

  /// @name Results, valid after `finish`
  /// @{
  const map::CSeabedSkyMap& map() const { return backend_.map(); }
  const graph::GraphSlam& graph() const { return backend_.graph(); }
  /// T_odom_vehicle at the end of every sweep, as the odometry gave it.
  const core::Trajectory& odometryTrajectory() const { return odometry_.sweepPoses(); }
  /// T_map_vehicle at the same times, corrected by the optimised keyframes around them.
  core::Trajectory trajectory() const;
  /// T_map_vehicle of the keyframes.
  core::Trajectory keyframeTrajectory() const;
  /// Mean height of the water surface in the map frame; zero on land.
  double waterHeight_m() const;
  /// Origin of the east-north-up frame that `graph().gnssReport()` refers to.
  const std::optional<GeodeticPosition>& gnssOrigin() const { return odometry_.gnssOrigin(); }
  std::uint64_t sweepCount() const { return odometry_.sweepCount(); }
  const SensorRouter& sensors() const { return router_; }
  /// @}

  FaultLog& faults() { return faults_; }
  const FaultLog& faults() const { return faults_; }
  /// In real time: for each stage from handing over a task until it is done, and from a record's `push` until its pose
  /// is known or its points are in the map.
  LatencyMonitor& latencies() { return latencies_; }
  const LatencyMonitor& latencies() const { return latencies_; }
  /// Time spent in each stage.
  const mrpt::system::CTimeLogger& profile() const { return profile_; }

 private:
  /// Prints nothing at its end, where MRPT's own would. It must outlive the workers, whose last tasks write to it.
  struct Profile : mrpt::system::CTimeLogger {
    ~Profile() override { clear(true); }
  };

  /// Runs a stage's work under a name in the profile.
  template <class Work>
  auto timed(const char* name, Work work) {
    return [this, name, posted = LatencyMonitor::Clock::now(), work = std::move(work)] {
      {
        const mrpt::system::CTimeLoggerEntry timer(profile_, name);
        work();
      }
      latencies_.add(name, LatencyMonitor::Clock::now() - posted);
    };
  }
  void onOdometry(OdometryUpdate update);
  void onSonarScan(const SonarScan& scan);
  /// Posts a record that may be dropped in real time; false if it was.
  bool postRecord(Worker& worker, Worker::Task task, const mrpt::obs::CObservation& observation);

  const SurveyConfig config_;
  FaultLog faults_;
  Profile profile_;
  LatencyMonitor latencies_;
  SensorRouter router_;
  // Each worker is declared after the stage it runs, last consumer first: they end in the opposite order.
  BackendStage backend_;
  Worker backendWorker_;
  SonarStage sonar_;
  Worker sonarWorker_;
  OdometryStage odometry_;
  Worker odometryWorker_;
};

}  // namespace s2s::mapper
