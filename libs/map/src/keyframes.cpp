#include "s2s/map/keyframes.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace s2s::map {

namespace {

/// The map pose that one keyframe alone gives: the odometry's motion since it, carried over.
core::Isometry carried(const Keyframe& keyframe, const core::Isometry& T_odom_vehicle) {
  return keyframe.T_map_vehicle * keyframe.T_odom_vehicle.inverse() * T_odom_vehicle;
}

bool timeBefore(core::TimeNs time, const Keyframe& keyframe) { return time < keyframe.time; }

}  // namespace

bool Keyframes::add(const Keyframe& keyframe) {
  if (indexOfId_.count(keyframe.id) != 0) return false;
  const auto place = std::upper_bound(keyframes_.begin(), keyframes_.end(), keyframe.time, timeBefore);
  const auto first = static_cast<std::size_t>(place - keyframes_.begin());
  keyframes_.insert(place, keyframe);
  for (std::size_t i = first; i < keyframes_.size(); ++i) indexOfId_[keyframes_[i].id] = i;
  return true;
}

std::size_t Keyframes::setPoses(const std::map<std::uint64_t, core::Isometry>& T_map_vehicle) {
  std::size_t found = 0;
  for (const auto& [id, T] : T_map_vehicle) {
    const auto entry = indexOfId_.find(id);
    if (entry == indexOfId_.end()) continue;
    keyframes_[entry->second].T_map_vehicle = T;
    ++found;
  }
  return found;
}

void Keyframes::clear() {
  keyframes_.clear();
  indexOfId_.clear();
}

const Keyframe* Keyframes::find(std::uint64_t id) const {
  const auto entry = indexOfId_.find(id);
  return entry == indexOfId_.end() ? nullptr : &keyframes_[entry->second];
}

core::Isometry Keyframes::poseAt(core::TimeNs time, const core::Isometry& T_odom_vehicle,
                                 PoseInterpolation mode) const {
  if (keyframes_.empty()) return T_odom_vehicle;
  const auto after = std::upper_bound(keyframes_.begin(), keyframes_.end(), time, timeBefore);
  if (after == keyframes_.begin()) return carried(keyframes_.front(), T_odom_vehicle);
  const Keyframe& a = *std::prev(after);
  if (after == keyframes_.end()) return carried(a, T_odom_vehicle);
  // a.time <= time < after->time, so the two differ and the share is well defined.
  const double share = core::secondsBetween(a.time, time) / core::secondsBetween(a.time, after->time);
  if (mode == PoseInterpolation::ConstantVelocity)
    return core::interpolate(a.T_map_vehicle, after->T_map_vehicle, share);
  return core::interpolate(carried(a, T_odom_vehicle), carried(*after, T_odom_vehicle), share);
}

core::Isometry Keyframes::poseFrom(std::uint64_t id, const core::Isometry& T_odom_vehicle) const {
  const Keyframe* keyframe = find(id);
  if (!keyframe) throw std::out_of_range("the map has no keyframe " + std::to_string(id));
  return carried(*keyframe, T_odom_vehicle);
}

}  // namespace s2s::map
