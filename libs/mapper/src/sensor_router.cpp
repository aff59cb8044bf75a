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

std::string className(const mrpt::obs::CObservation& observation) { return observation.GetRuntimeClass()->className; }

}  // namespace

SensorRouter::SensorRouter(const MapperOptions& options, FaultLog& faults) : options_(options), faults_(faults) {}

Role SensorRouter::roleOf(const std::string& label) const {
  if (label == options_.lidar.label) return Role::Lidar;
  if (label == options_.imu.label) return Role::Imu;
  if (label == options_.sonarHorizontal.label) return Role::SonarHorizontal;
  if (label == options_.sonarVertical.label) return Role::SonarVertical;
  if (label == options_.gnss.label) return Role::Gnss;
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
  if (time <= 0) {
    faults_.add("records of '" + label + "' without a time were dropped", where);
    return Role::None;
  }
  const auto index = static_cast<std::size_t>(role);
  if (counts_[index] > 0 && time <= lastOf_[index]) {
    faults_.add("records of '" + label + "' whose time does not advance were dropped", where);
    return Role::None;
  }
  const std::array<const SensorOptions*, kRoleCount> sensors = {
      &options_.lidar, &options_.imu, &options_.sonarHorizontal, &options_.sonarVertical, &options_.gnss};
  if (const auto& T = sensors[index]->T_vehicle_sensor) observation.setSensorPose(core::toPose(*T));
  if (std::accumulate(counts_.begin(), counts_.end(), std::uint64_t{0}) == 0) first_ = time;
  ++counts_[index];
  lastOf_[index] = time;
  first_ = std::min(first_, time);
  last_ = std::max(last_, time);
  return role;
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
