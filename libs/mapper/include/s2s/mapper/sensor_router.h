#pragma once

#include <mrpt/obs/CObservation.h>

#include <array>
#include <cstdint>
#include <map>
#include <string>

#include "s2s/core/time.h"
#include "s2s/mapper/fault_log.h"
#include "s2s/mapper/mapper_options.h"

namespace s2s::mapper {

/// What an observation is to the mapper.
enum class Role : std::uint8_t { Lidar = 0, Imu = 1, SonarHorizontal = 2, SonarVertical = 3, Gnss = 4, None = 5 };
constexpr std::size_t kRoleCount = 5;  ///< without None

/// Decides by label and class what each observation is, applies the configured mountings, and drops records that would
/// harm: without time, running backwards, more than an hour after the sensor's last one (a clock that was set, or
/// another survey: no motion model bridges that), or of a class that the role cannot use. Everything dropped is
/// counted.
class SensorRouter {
 public:
  /// @throws core::ConfigError if two sensors have one label, or the sound speed is none
  SensorRouter(const MapperOptions& options, FaultLog& faults);

  /// @param observation its sensor pose is replaced when the configuration gives one; of a ping also time, ranges and
  ///                    bearings are corrected by the configured time offset and sound speed
  /// @param where       place of the record, for the fault log
  Role route(mrpt::obs::CObservation& observation, const std::string& where);

  std::uint64_t count(Role role) const { return counts_[static_cast<std::size_t>(role)]; }

  /// Time of the first and of the last record that was used.
  core::TimeNs first() const { return first_; }
  core::TimeNs last() const { return last_; }

  /// @throws core::InputError if nothing can be mapped because no LiDAR sweep came; it names what the rawlog holds
  void requireLidar(const std::string& rawlog) const;

 private:
  Role roleOf(const std::string& label) const;
  bool timeFits(core::TimeNs time, Role role, const std::string& label, const std::string& where);
  /// Takes the configured time offset and sound speed into a ping.
  void correctPing(mrpt::obs::CObservation& observation, Role role);

  const MapperOptions& options_;
  FaultLog& faults_;
  std::array<std::uint64_t, kRoleCount + 1> counts_{};  // None is never counted
  std::array<core::TimeNs, kRoleCount + 1> lastOf_{};
  std::map<std::string, std::string> unusedClasses_;  // class name by label
  core::TimeNs first_ = 0, last_ = 0;
};

}  // namespace s2s::mapper
