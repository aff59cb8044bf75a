#pragma once

#include <cstdint>

#include "s2s/core/time.h"

namespace s2s::sim {

/// What goes wrong with one sensor's records; all off by default.
struct SensorFaults {
  double timeOffset_s = 0;  ///< recorded time = true time + this
  double jitter_s = 0;      ///< standard deviation of the recorded times
  double dropShare = 0;     ///< share of the records that get lost, at random
  double silentFrom_s = 0;  ///< the sensor gives nothing from here ...
  double silentFor_s = 0;   ///< ... for so long
};

/// Faults of a whole survey.
struct FaultOptions {
  SensorFaults lidar, imu, sonarHorizontal, sonarVertical, gnss;
  double clockJumpAt_s = 0;       ///< from here on all recorded times ...
  double clockJump_s = 0;         ///< ... are later by this (negative: earlier)
  int cutBytes = 0;               ///< bytes missing at the end of the rawlog, so that it ends within a record
  double spoofFrom_s = 0;         ///< from here on the GNSS drifts away ...
  double spoofDrift_mps = 0;      ///< ... at this speed ...
  double spoofDirection_rad = 0;  ///< ... in this direction of the world

  bool clockJumps() const { return clockJump_s != 0; }
};

/// Decides the fate of single records; a function of seed, sensor and number, so independent of threads.
class FaultInjector {
 public:
  FaultInjector(const FaultOptions& options, std::uint64_t seed) : options_(options), seed_(seed) {}

  const FaultOptions& options() const { return options_; }
  /// False if the record gets lost.
  bool delivers(const SensorFaults& faults, std::uint64_t sensor, std::uint64_t number, double t_s) const;
  /// What must be added to the record's true time.
  core::TimeNs timeError(const SensorFaults& faults, std::uint64_t sensor, std::uint64_t number, double t_s) const;

 private:
  FaultOptions options_;
  std::uint64_t seed_;
};

}  // namespace s2s::sim
