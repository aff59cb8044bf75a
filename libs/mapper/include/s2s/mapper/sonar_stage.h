#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <future>
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
/// Images are processed as pings come and handed to the odometry, whose pairs of pings come back as stereo points;
/// placing waits until the odometry covers a ping's time. So the output depends on the records' times only, not on how
/// threads interleave.
class SonarStage {
 public:
  struct Ping {
    Role role = Role::SonarHorizontal;
    std::shared_ptr<const obs::CObservationImagingSonar> observation;
  };
  using Output = std::function<void(SonarScan)>;

  SonarStage(const sonar::SonarOptions& options, FaultLog& faults, Output output);

  /// @param image receives the processed ping; null if the ping is unusable
  void addPing(const Ping& ping, std::promise<std::shared_ptr<const sonar::ProcessedPing>>& image);
  void addPoses(OdometryUpdate update);
  /// Nothing more comes: places what can be placed.
  void finish();

 private:
  struct Waiting {
    core::TimeNs time = 0;
    core::Isometry T_vehicle_sonar = core::Isometry::Identity();
    sonar::LineScan line;
  };
  using Queue = std::deque<Waiting>;

  /// Places all that the odometry's path covers.
  void advance();
  void abandonUntil(core::TimeNs time);
  void placeLineScans(Queue& pings, map::Layer layer);
  void placeLineScan(Waiting waiting, map::Layer layer, const core::Isometry& T_odom_vehicle);
  void placeStereo();

  FaultLog& faults_;
  Output output_;
  sonar::SonarStereo images_;
  Queue horizontal_, vertical_;
  core::Trajectory poses_;  // T_odom_vehicle
  std::deque<StereoScan> stereo_;
};

}  // namespace s2s::mapper
