#include "ping_motion.h"

namespace s2s::calib {

namespace {

constexpr double kStep_s = 0.01;       // for velocities
constexpr double kMaxPoseGap_s = 0.5;  // of the trajectory
constexpr double kMaxRate_radps = 2;   // faster than this no vessel moves: the trajectory jumps there, ...
constexpr double kMaxSpeed_mps = 20;   // ... and its derivative would tell times that are not true

}  // namespace

std::optional<PingMotion> pingMotionAt(const core::Trajectory& T_map_vehicle, core::TimeNs recorded,
                                       const SonarState& sonar) {
  const core::TimeNs time = recorded - core::durationNs(sonar.correctedTimeOffset_s());
  const auto T = T_map_vehicle.at(time, kMaxPoseGap_s);
  const auto before = T_map_vehicle.at(time - core::durationNs(kStep_s), kMaxPoseGap_s);
  const auto after = T_map_vehicle.at(time + core::durationNs(kStep_s), kMaxPoseGap_s);
  if (!T || !before || !after) return {};
  PingMotion motion;
  motion.T_map_vehicle = *T;
  motion.velocity_mps = T->linear().transpose() * (after->translation() - before->translation()) / (2 * kStep_s);
  motion.rate_radps = core::logSo3(before->linear().transpose() * after->linear()) / (2 * kStep_s);
  motion.timeOffset_s = sonar.correction[kTime];
  if (motion.rate_radps.norm() > kMaxRate_radps || motion.velocity_mps.norm() > kMaxSpeed_mps) return {};
  return motion;
}

}  // namespace s2s::calib
