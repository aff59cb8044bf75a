#pragma once

#include <optional>
#include <vector>

#include "s2s/core/time.h"
#include "s2s/core/transform.h"

namespace s2s::core {

struct TimedPose {
  TimeNs time = 0;
  Isometry T = Isometry::Identity();  ///< T_frame_vehicle at `time`
};

/// Poses of one body in one frame, in time order.
class Trajectory {
 public:
  Trajectory() = default;
  /// Takes poses in any order and sorts them by time; of equal times the last one stays.
  explicit Trajectory(std::vector<TimedPose> poses);

  /// Appends a pose; one not later than the last is refused with `false`.
  bool append(TimeNs time, const Isometry& T);

  bool empty() const { return poses_.empty(); }
  std::size_t size() const { return poses_.size(); }
  const std::vector<TimedPose>& poses() const { return poses_; }
  const TimedPose& front() const { return poses_.front(); }
  const TimedPose& back() const { return poses_.back(); }

  /// Pose at `time` by geodesic interpolation between its neighbours. Nothing if `time` is outside, or if the
  /// neighbours are further apart than `maxGap_s` (zero or less: any gap will do).
  std::optional<Isometry> at(TimeNs time, double maxGap_s = 0) const;

  /// Drops all poses before `time` but the last of them, so that `at(time)` still works.
  void forgetBefore(TimeNs time);

  /// Sum of the distances between successive poses, in metres.
  double length_m() const;

 private:
  std::vector<TimedPose> poses_;
};

}  // namespace s2s::core
