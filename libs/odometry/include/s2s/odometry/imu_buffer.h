#pragma once

#include <deque>
#include <vector>

#include "s2s/odometry/imu_sample.h"

namespace s2s::odometry {

/// A short time over which angular rate and specific force are taken as constant.
struct MotionStep {
  core::TimeNs end = 0;
  double duration_s = 0;
  Eigen::Vector3d angularRate_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d specificForce_mps2 = Eigen::Vector3d::Zero();
  /// How the two change, for a later correction of the time offset that the readings were taken with.
  Eigen::Vector3d angularRateSlope_radps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d specificForceSlope_mps3 = Eigen::Vector3d::Zero();
  double timeOffset_s = 0;
  bool isMeasured = true;  ///< false: bridged, there was no IMU
};

/// Samples waiting for the scans they belong to.
class ImuBuffer {
 public:
  /// False, and the sample is not taken, if its time does not grow or a value is not finite.
  bool add(const ImuSample& sample);

  bool empty() const { return samples_.empty(); }
  const std::deque<ImuSample>& samples() const { return samples_; }
  core::TimeNs lastTime() const { return samples_.back().time; }

  /// Steps from one time to another, cut at the samples: within a step the mean of the linearly interpolated readings
  /// at its ends. Silences longer than `maxGap_s` and times outside the samples give steps that are not measured, of
  /// at most 10 ms, with the last known angular rate.
  /// @param timeOffset_s  time stamp of a sample less the time that counts; `from`, `to` and the steps are of the
  /// latter
  std::vector<MotionStep> steps(core::TimeNs from, core::TimeNs to, double maxGap_s, double timeOffset_s = 0) const;

  /// Drops samples that are not needed for times from `time` on.
  void forgetBefore(core::TimeNs time);

 private:
  std::deque<ImuSample> samples_;
};

}  // namespace s2s::odometry
