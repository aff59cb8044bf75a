#pragma once

#include <cstdint>
#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

#include "s2s/core/time.h"
#include "s2s/core/transform.h"

namespace s2s::map {

/// A pose of the vehicle that the graph optimises; everything in the map hangs on such poses.
struct Keyframe {
  std::uint64_t id = 0;  ///< the node's id in the pose graph
  core::TimeNs time = 0;
  core::Isometry T_odom_vehicle = core::Isometry::Identity();  ///< as the odometry had it; never changes
  core::Isometry T_map_vehicle = core::Isometry::Identity();   ///< as the graph has it now
};

/// How the vehicle's pose between two keyframes is found.
enum class PoseInterpolation : std::uint8_t {
  Odometry = 0,         ///< the odometry's own pose at that time, corrected by the keyframes around it
  ConstantVelocity = 1  ///< the paper: linear motion at constant velocity from one keyframe to the next
};

/// The keyframes in order of time, and the vehicle's pose in the map at any time.
class Keyframes {
 public:
  /// @return false if the id is taken already: nothing is added then
  bool add(const Keyframe& keyframe);

  /// New optimised poses by id; ids the map does not know are ignored.
  /// @return number of keyframes found
  std::size_t setPoses(const std::map<std::uint64_t, core::Isometry>& T_map_vehicle);

  const std::vector<Keyframe>& all() const { return keyframes_; }
  bool empty() const { return keyframes_.empty(); }
  void clear();
  const Keyframe* find(std::uint64_t id) const;

  /// T_map_vehicle at `time`, where the odometry has `T_odom_vehicle`.
  ///
  /// Between keyframes a and b (Odometry): each carries the odometry's motion since itself into the map,
  /// T_map_a T_odom_a^-1 T_odom_vehicle, and the two are mixed by share of time. Mixing poses rather than corrections
  /// keeps the result independent of how far away the odometry's origin is. Before the first and after the last
  /// keyframe that one alone decides, in either mode. Without keyframes map and odometry frame are the same.
  core::Isometry poseAt(core::TimeNs time, const core::Isometry& T_odom_vehicle, PoseInterpolation mode) const;

  /// The same for something that belongs to one keyframe whatever its time.
  /// @throws std::out_of_range if there is no such keyframe
  core::Isometry poseFrom(std::uint64_t id, const core::Isometry& T_odom_vehicle) const;

 private:
  std::vector<Keyframe> keyframes_;  // by time
  // Ids arrive in order of time nearly always, so a sorted list of (id, index) would be rebuilt at each late one; this
  // map is rebuilt from the first moved entry only.
  std::unordered_map<std::uint64_t, std::size_t> indexOfId_;
};

}  // namespace s2s::map
