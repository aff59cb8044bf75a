#include "s2s/mapper/sensor_router.h"

#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <numeric>

#include "s2s/core/error.h"
#include "s2s/obs/CObservationImagingSonar.h"
#include "s2s/obs/CObservationLidarSweep.h"
#include "s2s/sonar/sound_speed.h"

namespace s2s::mapper {

namespace {

bool classFits(Role role, const mrpt::obs::CObservation& observation) {
  switch (role) {
    case Role::Lidar:
      return dynamic_cast<const obs::CObservationLidarSweep*>(&observation) ||
             dynamic_cast<const mrpt::obs::CObservationPointCloud*>(&observation);
    case Role::Imu:
      return dynamic_cast<const mrpt::obs::CObservationIMU*>(&observation) != nullptr;
    case Role::SonarHorizontal:
    case Role::SonarVertical:
      return dynamic_cast<const obs::CObservationImagingSonar*>(&observation) != nullptr;
    case Role::Gnss:
      return dynamic_cast<const mrpt::obs::CObservationGPS*>(&observation) != nullptr;
    case Role::None:
      break;
  }
  return true;
}

/// Longer silence of a sensor is not bridged.
constexpr core::TimeNs kLongestPause = 3600 * core::kNsPerSecond;
/// Sound is slower nowhere in fresh or salt water, and faster only under kilometres of it.
constexpr double kLeastSoundSpeed_mps = 1300, kMostSoundSpeed_mps = 1700;

using Sensors = std::array<const SensorOptions*, kRoleCount>;

/// In the order of their roles.
Sensors sensorsOf(const MapperOptions& o) { return {&o.lidar, &o.imu, &o.sonarHorizontal, &o.sonarVertical, &o.gnss}; }

void check(const MapperOptions& options) {
  const Sensors sensors = sensorsOf(options);
  for (std::size_t i = 0; i < sensors.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (sensors[i]->label == sensors[j]->label)
        throw core::ConfigError("two sensors have the label '" + sensors[i]->label + "'", "[mapper] label_...",
                                "give each sensor the label of its own records");
  const double c_mps = options.soundSpeed_mps;
  if (c_mps != 0 && (c_mps < kLeastSoundSpeed_mps || c_mps > kMostSoundSpeed_mps))
    throw core::ConfigError("no water has this sound speed", "[mapper] sound_speed_mps",
                            "give 1300 to 1700 m/s, or 0 for the devices' own");
}

std::string className(const mrpt::obs::CObservation& observation) { return observation.GetRuntimeClass()->className; }

}  // namespace

SensorRouter::SensorRouter(const MapperOptions& options, FaultLog& faults) : options_(options), faults_(faults) {
  check(options);
}

Role SensorRouter::roleOf(const std::string& label) const {
  const Sensors sensors = sensorsOf(options_);
  for (std::size_t i = 0; i < sensors.size(); ++i)
    if (label == sensors[i]->label) return static_cast<Role>(i);
  return Role::None;
}

Role SensorRouter::route(mrpt::obs::CObservation& observation, const std::string& where) {
  const std::string& label = observation.sensorLabel;
  const Role role = roleOf(label);
  if (role == Role::None) {
    unusedClasses_.emplace(label, className(observation));
    faults_.add("records of '" + label + "' (" + className(observation) + ") are not used", where);
    return Role::None;
  }
  if (!classFits(role, observation)) {
    unusedClasses_.emplace(label, className(observation));
    faults_.add(
        "records of '" + label + "' are of class " + className(observation) + ", which cannot be used as that sensor",
        where);
    return Role::None;
  }
  if (core::fromMrptTime(observation.timestamp) > 0) correctPing(observation, role);
  const core::TimeNs time = core::fromMrptTime(observation.timestamp);
  if (!timeFits(time, role, label, where)) return Role::None;
  const auto index = static_cast<std::size_t>(role);
  if (const auto& T = sensorsOf(options_)[index]->T_vehicle_sensor) observation.setSensorPose(core::toPose(*T));
  if (std::accumulate(counts_.begin(), counts_.end(), std::uint64_t{0}) == 0) first_ = time;
  ++counts_[index];
  lastOf_[index] = time;
  first_ = std::min(first_, time);
  last_ = std::max(last_, time);
  return role;
}

bool SensorRouter::timeFits(core::TimeNs time, Role role, const std::string& label, const std::string& where) {
  const auto index = static_cast<std::size_t>(role);
  const auto drop = [&](const std::string& why) {
    faults_.add("records of '" + label + "' " + why, where);
    return false;
  };
  if (time <= 0) return drop("without a time were dropped");
  if (counts_[index] == 0) return true;
  if (time <= lastOf_[index]) return drop("whose time does not advance were dropped");
  if (time - lastOf_[index] > kLongestPause)
    return drop(
        "more than an hour after the one before were dropped: the recording paused or its clock was set; map the parts "
        "one by one with --from and --to");
  return true;
}

void SensorRouter::correctPing(mrpt::obs::CObservation& observation, Role role) {
  if (role != Role::SonarHorizontal && role != Role::SonarVertical) return;
  const double offset_s =
      role == Role::SonarHorizontal ? options_.timeOffsetHorizontal_s : options_.timeOffsetVertical_s;
  if (offset_s != 0)
    observation.timestamp = core::toMrptTime(core::fromMrptTime(observation.timestamp) - core::durationNs(offset_s));
  if (options_.soundSpeed_mps > 0 &&
      !sonar::correctSoundSpeed(dynamic_cast<obs::CObservationImagingSonar&>(observation), options_.soundSpeed_mps))
    faults_.add("pings of '" + observation.sensorLabel +
                "' do not tell the sound speed they were made with, so sound_speed_mps does not change them");
}

void SensorRouter::requireLidar(const std::string& rawlog) const {
  if (count(Role::Lidar) > 0) return;
  std::string found;
  for (const auto& [label, name] : unusedClasses_)
    found += (found.empty() ? "" : ", ") + ("'" + label + "' (" + name + ")");
  throw core::InputError("no LiDAR sweep labelled '" + options_.lidar.label + "', so nothing can be mapped", rawlog,
                         found.empty() ? "record a LiDAR along with the sonars"
                                       : "set label_lidar in [mapper] to the LiDAR among: " + found);
}

}  // namespace s2s::mapper
