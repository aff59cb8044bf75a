#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>

#include "s2s/core/trajectory.h"
#include "s2s/mapper/fault_log.h"
#include "s2s/mapper/messages.h"
#include "s2s/mapper/sensor_router.h"
#include "s2s/obs/CObservationImagingSonar.h"
#include "s2s/sonar/options_table.h"

namespace s2s::mapper {

/// Second stage: pings in, line-scans and stereo points out, each with the odometry's pose at its time.
///
/// Images are processed as pings come; placing waits until the odometry covers a ping's time, and pairing until no
/// better partner can come. So the output depends on the records' times only, not on how threads interleave.
class SonarStage {
 public:
  struct Options {
    sonar::SonarOptions sonar;
    double stereoPairWindow_s = 0.04;
  };
  struct Ping {
    Role role = Role::SonarHorizontal;
    std::shared_ptr<const obs::CObservationImagingSonar> observation;
  };
  using Output = std::function<void(SonarScan)>;

  SonarStage(const Options& options, FaultLog& faults, Output output);

  void addPing(const Ping& ping);
  void addPoses(const OdometryUpdate& update);
  /// Nothing more comes: places what can be placed.
  void finish();

  /// Pairs of pings that were searched for stereo points.
  std::uint64_t pairCount() const { return pairCount_; }

 private:
  struct Waiting {
    core::TimeNs time = 0;
    core::Isometry T_vehicle_sonar = core::Isometry::Identity();
    sonar::ProcessedPing ping;
    bool placed = false;
  };
  using Queue = std::deque<Waiting>;

  /// Does all that can be done now that the odometry's path and the records until `completeUntil` are known.
  void advance(core::TimeNs completeUntil);
  void placeLineScans(Queue& pings, map::Layer layer);
  void placeLineScan(const Waiting& waiting, map::Layer layer, const core::Isometry& T_odom_vehicle);
  /// Pairs the oldest ping of the vertical (slower) sonar; false if it has to wait.
  bool pairOldestVertical(core::TimeNs completeUntil);
  const Waiting* nearestHorizontal(core::TimeNs time) const;
  void fuse(const Waiting& horizontal, const Waiting& vertical);

  Options options_;
  FaultLog& faults_;
  Output output_;
  sonar::SonarStereo stereo_;
  Queue horizontal_, vertical_;
  core::Trajectory poses_;  // T_odom_vehicle
  std::uint64_t pairCount_ = 0;
};

}  // namespace s2s::mapper
