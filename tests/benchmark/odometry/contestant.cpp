#include "contestant.h"

#include <ctime>

namespace s2s::bench {

namespace {

/// As in the mapper; stereo needs the motion of the last tenths of a second.
constexpr double kTrajectoryMemory_s = 5.0;

double threadSeconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

void Contestant::imu(const odometry::ImuSample& sample) {
  const double start = threadSeconds();
  takeImu(sample);
  sinceSweep_s_ += threadSeconds() - start;
}

void Contestant::sweep(const obs::CObservationLidarSweep& sweep) {
  const double start = threadSeconds();
  takeSweep(sweep);
  seconds_.push_back(sinceSweep_s_ + threadSeconds() - start);
  sinceSweep_s_ = 0;
}

void Contestant::finish() { takeEnd(); }

void Contestant::keep(odometry::OdometryResult result) {
  if (result.status == odometry::OdometryStatus::skipped) return;
  result.points_vehicle.clear();
  result.points_vehicle.shrink_to_fit();
  result.path.clear();
  result.path.shrink_to_fit();
  results_.push_back(std::move(result));
}

OurOdometry::OurOdometry(std::string name, const odometry::OdometryOptions& options, double leastGap_s)
    : Contestant(std::move(name)), maker_(options.scan), odometry_(options), leastGap_s_(leastGap_s) {}

void OurOdometry::takeImu(const odometry::ImuSample& sample) {
  odometry_.addImu(sample);
  drain();
}

void OurOdometry::takeSweep(const obs::CObservationLidarSweep& sweep) {
  const core::TimeNs time = core::fromMrptTime(sweep.timestamp);
  if (core::secondsBetween(last_, time) < leastGap_s_) return;
  last_ = time;
  odometry_.addScan(maker_.fromSweep(sweep));
  drain();
}

void OurOdometry::takeEnd() {
  odometry_.finish();
  drain();
}

void OurOdometry::drain() {
  while (auto result = odometry_.next()) {
    odometry_.forgetTrajectoryBefore(result->time - core::durationNs(kTrajectoryMemory_s));
    keep(std::move(*result));
  }
}

}  // namespace s2s::bench
