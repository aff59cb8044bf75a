#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <vector>

#include "s2s/core/time.h"
#include "s2s/core/transform.h"
#include "s2s/map/scan.h"
#include "s2s/mapper/sensor_router.h"
#include "s2s/sonar/options_table.h"
#include "s2s/sonar/sonar_stereo.h"

namespace s2s::mapper {

/// A ping whose image is being processed, perhaps in another thread.
struct PendingPing {
  Role role = Role::SonarHorizontal;
  core::TimeNs time = 0;
  core::Isometry T_vehicle_sonar = core::Isometry::Identity();
  /// Null if the ping is unusable; never set if the stage that makes it failed, which is told elsewhere.
  std::shared_future<std::shared_ptr<const sonar::ProcessedPing>> image;
};

/// Points of a pair of pings, in the vehicle's frame at the horizontal one.
struct StereoScan {
  core::TimeNs time = 0;
  std::vector<map::ScanPoint> points;
};

/// Pairs each ping of the vertical (slower) sonar with the nearest one of the horizontal and triangulates. A pair is
/// made as soon as no better partner can come, so it depends on the pings' times only.
class StereoPairer {
 public:
  /// T_from_to of the vehicle between two moments.
  using Motion = std::function<core::Isometry(core::TimeNs from, core::TimeNs to)>;

  StereoPairer(const sonar::SonarOptions& options, double window_s, Motion motion);

  /// Takes a ping; pings of one sonar come in order of time.
  /// @return points of the pairs that this ping completes, in order of time
  std::vector<StereoScan> add(PendingPing ping);
  /// No ping will come any more.
  std::vector<StereoScan> finish();

 private:
  std::vector<StereoScan> pairUntil(core::TimeNs newest);
  const PendingPing* nearestHorizontal(core::TimeNs time) const;
  StereoScan fuse(const PendingPing& horizontal, const PendingPing& vertical);

  sonar::SonarStereo stereo_;
  core::TimeNs window_;
  Motion motion_;
  std::deque<PendingPing> horizontal_, vertical_;
};

}  // namespace s2s::mapper
