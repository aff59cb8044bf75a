#include "s2s/mapper/sonar_stage.h"

#include <cmath>
#include <limits>

#include "s2s/core/error.h"

namespace s2s::mapper {

namespace {

/// Poses this much older than the oldest waiting ping are of no more use.
constexpr double kPoseMemory_s = 1.0;

}  // namespace

SonarStage::SonarStage(const Options& options, FaultLog& faults, Output output)
    : options_(options),
      faults_(faults),
      output_(std::move(output)),
      stereo_(options.sonar.horizontal, options.sonar.vertical, options.sonar.stereo) {}

void SonarStage::addPing(const Ping& ping) {
  const bool isHorizontal = ping.role == Role::SonarHorizontal;
  Waiting waiting;
  waiting.time = core::fromMrptTime(ping.observation->timestamp);
  waiting.T_vehicle_sonar = core::toIsometry(ping.observation->sensorPose);
  try {
    waiting.ping = (isHorizontal ? stereo_.horizontal() : stereo_.vertical()).process(*ping.observation);
  } catch (const core::InputError& e) {
    faults_.add("unusable pings were dropped: " + e.fault(), core::formatUtc(waiting.time));
    return;
  }
  (isHorizontal ? horizontal_ : vertical_).push_back(std::move(waiting));
}

void SonarStage::addPoses(const OdometryUpdate& update) {
  for (const auto& pose : update.path) poses_.append(pose.time, pose.T);
  advance(update.completeUntil);
}

void SonarStage::finish() {
  advance(std::numeric_limits<core::TimeNs>::max());
  const std::size_t unplaced = horizontal_.size() + vertical_.size();
  faults_.add("pings after the last pose of the odometry were not placed", {}, unplaced);
}

void SonarStage::advance(core::TimeNs completeUntil) {
  if (poses_.empty()) return;
  placeLineScans(horizontal_, map::Layer::LineHorizontal);
  placeLineScans(vertical_, map::Layer::LineVertical);
  while (pairOldestVertical(completeUntil)) {
  }
  // A horizontal ping is done with when every vertical ping it could pair with has been.
  const core::TimeNs window = core::durationNs(options_.stereoPairWindow_s);
  const core::TimeNs oldestPartner =
      vertical_.empty() ? std::min(completeUntil, poses_.back().time) : vertical_.front().time;
  while (!horizontal_.empty() && horizontal_.front().placed && horizontal_.front().time < oldestPartner - window)
    horizontal_.pop_front();
  core::TimeNs oldest = poses_.back().time;
  if (!horizontal_.empty()) oldest = std::min(oldest, horizontal_.front().time);
  if (!vertical_.empty()) oldest = std::min(oldest, vertical_.front().time);
  poses_.forgetBefore(oldest - core::durationNs(kPoseMemory_s));
}

void SonarStage::placeLineScans(Queue& pings, map::Layer layer) {
  for (Waiting& waiting : pings) {
    if (waiting.placed) continue;
    if (waiting.time > poses_.back().time) break;
    waiting.placed = true;
    if (const auto T_odom_vehicle = poses_.at(waiting.time))
      placeLineScan(waiting, layer, *T_odom_vehicle);
    else
      faults_.add("pings before the first pose of the odometry were not placed", core::formatUtc(waiting.time));
  }
}

void SonarStage::placeLineScan(const Waiting& waiting, map::Layer layer, const core::Isometry& T_odom_vehicle) {
  SonarScan scan;
  scan.layer = layer;
  scan.time = waiting.time;
  scan.T_odom_vehicle = T_odom_vehicle;
  scan.T_vehicle_sonar = waiting.T_vehicle_sonar;
  scan.line = waiting.ping.lineScan;
  output_(std::move(scan));
}

bool SonarStage::pairOldestVertical(core::TimeNs completeUntil) {
  if (vertical_.empty() || !vertical_.front().placed) return false;
  const core::TimeNs window = core::durationNs(options_.stereoPairWindow_s);
  const Waiting& vertical = vertical_.front();
  if (completeUntil < vertical.time || completeUntil - vertical.time < window) return false;
  const Waiting* horizontal = nearestHorizontal(vertical.time);
  if (horizontal && !horizontal->placed) return false;
  if (horizontal) fuse(*horizontal, vertical);
  vertical_.pop_front();
  return true;
}

const SonarStage::Waiting* SonarStage::nearestHorizontal(core::TimeNs time) const {
  const Waiting* nearest = nullptr;
  core::TimeNs smallest = core::durationNs(options_.stereoPairWindow_s) + 1;
  for (const Waiting& waiting : horizontal_) {
    const core::TimeNs gap = std::abs(waiting.time - time);
    if (gap >= smallest) continue;
    smallest = gap;
    nearest = &waiting;
  }
  return nearest;
}

void SonarStage::fuse(const Waiting& horizontal, const Waiting& vertical) {
  const auto T_odom_h = poses_.at(horizontal.time), T_odom_v = poses_.at(vertical.time);
  if (!T_odom_h || !T_odom_v) return;  // counted when its line-scan was placed
  const core::Isometry T_h_v =
      (*T_odom_h * horizontal.T_vehicle_sonar).inverse() * *T_odom_v * vertical.T_vehicle_sonar;
  const auto result = stereo_.process(horizontal.ping, vertical.ping, T_h_v);
  ++pairCount_;

  SonarScan scan;
  scan.layer = map::Layer::Stereo;
  scan.time = horizontal.time;
  scan.T_odom_vehicle = *T_odom_h;
  for (const auto& point : result.points)
    scan.points.push_back(
        {(horizontal.T_vehicle_sonar * point.p_h).cast<float>(), point.intensity, static_cast<float>(point.sigma_m())});
  if (!scan.points.empty()) output_(std::move(scan));
}

}  // namespace s2s::mapper
