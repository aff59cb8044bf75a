#include "s2s/odometry/imu_buffer.h"

#include <algorithm>

namespace s2s::odometry {

namespace {

constexpr double kBridgeStep_s = 0.01;

bool earlier(const ImuSample& sample, core::TimeNs time) { return sample.time < time; }

/// Mean of the readings, linear between two samples, from `from` to `to`.
MotionStep measuredStep(const ImuSample& before, const ImuSample& after, core::TimeNs from, core::TimeNs to) {
  const double middle_s = 0.5 * (core::secondsBetween(before.time, from) + core::secondsBetween(before.time, to));
  const double u = middle_s / core::secondsBetween(before.time, after.time);
  MotionStep step;
  step.end = to;
  step.duration_s = core::secondsBetween(from, to);
  step.angularRate_radps = (1 - u) * before.angularRate_radps + u * after.angularRate_radps;
  step.specificForce_mps2 = (1 - u) * before.specificForce_mps2 + u * after.specificForce_mps2;
  const double between_s = core::secondsBetween(before.time, after.time);
  step.angularRateSlope_radps2 = (after.angularRate_radps - before.angularRate_radps) / between_s;
  step.specificForceSlope_mps3 = (after.specificForce_mps2 - before.specificForce_mps2) / between_s;
  return step;
}

void bridge(core::TimeNs from, core::TimeNs to, const Eigen::Vector3d& angularRate, std::vector<MotionStep>& steps) {
  const int count = std::max(1, static_cast<int>(std::ceil(core::secondsBetween(from, to) / kBridgeStep_s)));
  core::TimeNs start = from;
  for (int i = 1; i <= count; ++i) {
    MotionStep step;
    step.end = from + (to - from) * i / count;
    step.duration_s = core::secondsBetween(start, step.end);
    step.angularRate_radps = angularRate;
    step.isMeasured = false;
    steps.push_back(step);
    start = step.end;
  }
}

}  // namespace

bool ImuBuffer::add(const ImuSample& sample) {
  if (!sample.angularRate_radps.allFinite() || !sample.specificForce_mps2.allFinite()) return false;
  if (!samples_.empty() && sample.time <= samples_.back().time) return false;
  samples_.push_back(sample);
  return true;
}

std::vector<MotionStep> ImuBuffer::steps(core::TimeNs from, core::TimeNs to, double maxGap_s,
                                         double timeOffset_s) const {
  std::vector<MotionStep> steps;
  const core::TimeNs offset = core::durationNs(timeOffset_s);
  from += offset;
  to += offset;
  while (from < to) {
    // The pair of samples around the moment after `from`.
    const auto after = std::lower_bound(samples_.begin(), samples_.end(), from + 1, earlier);
    const bool hasBefore = after != samples_.begin(), hasAfter = after != samples_.end();
    const core::TimeNs end = hasAfter ? std::min(to, after->time) : to;
    const bool isCovered =
        hasBefore && hasAfter && core::secondsBetween(std::prev(after)->time, after->time) <= maxGap_s;
    if (isCovered)
      steps.push_back(measuredStep(*std::prev(after), *after, from, end));
    else
      bridge(from, end, hasBefore ? std::prev(after)->angularRate_radps : Eigen::Vector3d(Eigen::Vector3d::Zero()),
             steps);
    from = end;
  }
  for (auto& step : steps) {
    step.end -= offset;
    step.timeOffset_s = timeOffset_s;
  }
  return steps;
}

void ImuBuffer::forgetBefore(core::TimeNs time) {
  while (samples_.size() >= 2 && samples_[1].time <= time) samples_.pop_front();
}

}  // namespace s2s::odometry
