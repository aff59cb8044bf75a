#include "s2s/sim/faults.h"

#include "s2s/sim/random.h"

namespace s2s::sim {

bool FaultInjector::delivers(const SensorFaults& f, std::uint64_t sensor, std::uint64_t number, double t_s) const {
  if (t_s >= f.silentFrom_s && t_s < f.silentFrom_s + f.silentFor_s) return false;
  if (f.dropShare <= 0) return true;
  return Random(seed_, 0x64726f70 + sensor, number).uniform() >= f.dropShare;
}

core::TimeNs FaultInjector::timeError(const SensorFaults& f, std::uint64_t sensor, std::uint64_t number,
                                      double t_s) const {
  double error_s = f.timeOffset_s;
  if (f.jitter_s > 0) error_s += f.jitter_s * Random(seed_, 0x6a697474 + sensor, number).normal();
  if (options_.clockJumps() && t_s >= options_.clockJumpAt_s) error_s += options_.clockJump_s;
  return core::durationNs(error_s);
}

}  // namespace s2s::sim
