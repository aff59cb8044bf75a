#include "s2s/core/trajectory.h"

#include <algorithm>

namespace s2s::core {

namespace {

bool earlier(const TimedPose& pose, TimeNs time) { return pose.time < time; }

}  // namespace

Trajectory::Trajectory(std::vector<TimedPose> poses) {
  std::stable_sort(poses.begin(), poses.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
  for (auto& pose : poses) {
    if (!poses_.empty() && poses_.back().time == pose.time)
      poses_.back() = pose;
    else
      poses_.push_back(pose);
  }
}

bool Trajectory::append(TimeNs time, const Isometry& T) {
  if (!poses_.empty() && time <= poses_.back().time) return false;
  poses_.push_back({time, T});
  return true;
}

std::optional<Isometry> Trajectory::at(TimeNs time, double maxGap_s) const {
  const auto after = std::lower_bound(poses_.begin(), poses_.end(), time, earlier);
  if (after == poses_.end()) return std::nullopt;
  if (after->time == time) return after->T;
  if (after == poses_.begin()) return std::nullopt;
  const auto before = std::prev(after);
  const double gap_s = secondsBetween(before->time, after->time);
  if (maxGap_s > 0 && gap_s > maxGap_s) return std::nullopt;
  return interpolate(before->T, after->T, secondsBetween(before->time, time) / gap_s);
}

void Trajectory::forgetBefore(TimeNs time) {
  auto first = std::lower_bound(poses_.begin(), poses_.end(), time, earlier);
  if (first == poses_.begin()) return;
  poses_.erase(poses_.begin(), std::prev(first));
}

double Trajectory::length_m() const {
  double length = 0;
  for (std::size_t i = 1; i < poses_.size(); ++i)
    length += (poses_[i].T.translation() - poses_[i - 1].T.translation()).norm();
  return length;
}

}  // namespace s2s::core
