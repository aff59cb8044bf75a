#include "s2s/mapper/sonar_stage.h"

#include <iterator>

#include "s2s/core/error.h"

namespace s2s::mapper {

namespace {

/// Poses this much older than the newest one and the oldest waiting ping are of no more use: a recorder may write pings
/// so much later than sweeps.
constexpr double kPoseMemory_s = 30.0;

}  // namespace

SonarStage::SonarStage(const sonar::SonarOptions& options, FaultLog& faults, Output output)
    : faults_(faults), output_(std::move(output)), images_(options.horizontal, options.vertical, options.stereo) {}

void SonarStage::addPing(const Ping& ping, std::promise<std::shared_ptr<const sonar::ProcessedPing>>& image) {
  const bool isHorizontal = ping.role == Role::SonarHorizontal;
  Waiting waiting;
  waiting.time = core::fromMrptTime(ping.observation->timestamp);
  waiting.T_vehicle_sonar = core::toIsometry(ping.observation->sensorPose);
  try {
    const auto processed = std::make_shared<const sonar::ProcessedPing>(
        (isHorizontal ? images_.horizontal() : images_.vertical()).process(*ping.observation));
    waiting.line = processed->lineScan;
    image.set_value(processed);
  } catch (const core::InputError& e) {
    faults_.add("unusable pings were dropped: " + e.fault(), core::formatUtc(waiting.time));
    image.set_value(nullptr);
    return;
  }
  (isHorizontal ? horizontal_ : vertical_).push_back(std::move(waiting));
}

void SonarStage::addPoses(OdometryUpdate update) {
  for (const auto& pose : update.path) poses_.append(pose.time, pose.T);
  std::move(update.stereo.begin(), update.stereo.end(), std::back_inserter(stereo_));
  if (update.abandonedUntil > 0) abandonUntil(update.abandonedUntil);
  advance();
}

void SonarStage::finish() {
  advance();
  faults_.add("pings after the last pose of the odometry were not placed", {}, horizontal_.size() + vertical_.size());
}

void SonarStage::advance() {
  if (poses_.empty()) return;
  placeLineScans(horizontal_, map::Layer::LineHorizontal);
  placeLineScans(vertical_, map::Layer::LineVertical);
  placeStereo();
  core::TimeNs oldest = poses_.back().time;
  if (!horizontal_.empty()) oldest = std::min(oldest, horizontal_.front().time);
  if (!vertical_.empty()) oldest = std::min(oldest, vertical_.front().time);
  if (!stereo_.empty()) oldest = std::min(oldest, stereo_.front().time);
  poses_.forgetBefore(oldest - core::durationNs(kPoseMemory_s));
}

void SonarStage::abandonUntil(core::TimeNs time) {
  for (Queue* pings : {&horizontal_, &vertical_})
    for (; !pings->empty() && pings->front().time <= time; pings->pop_front())
      faults_.add("pings were not placed because no LiDAR sweep had given a pose for a minute",
                  core::formatUtc(pings->front().time));
  while (!stereo_.empty() && stereo_.front().time <= time) stereo_.pop_front();
}

void SonarStage::placeStereo() {
  for (; !stereo_.empty() && stereo_.front().time <= poses_.back().time; stereo_.pop_front()) {
    const auto T_odom_vehicle = poses_.at(stereo_.front().time);
    if (!T_odom_vehicle) continue;  // counted when its line-scan was placed
    SonarScan scan;
    scan.layer = map::Layer::Stereo;
    scan.time = stereo_.front().time;
    scan.T_odom_vehicle = *T_odom_vehicle;
    scan.points = std::move(stereo_.front().points);
    output_(std::move(scan));
  }
}

void SonarStage::placeLineScans(Queue& pings, map::Layer layer) {
  for (; !pings.empty() && pings.front().time <= poses_.back().time; pings.pop_front()) {
    Waiting& waiting = pings.front();
    if (const auto T_odom_vehicle = poses_.at(waiting.time))
      placeLineScan(std::move(waiting), layer, *T_odom_vehicle);
    else
      faults_.add(
          "pings before the first pose of the odometry, or long after the sweeps of their time, were not placed",
          core::formatUtc(waiting.time));
  }
}

void SonarStage::placeLineScan(Waiting waiting, map::Layer layer, const core::Isometry& T_odom_vehicle) {
  SonarScan scan;
  scan.layer = layer;
  scan.time = waiting.time;
  scan.T_odom_vehicle = T_odom_vehicle;
  scan.T_vehicle_sonar = waiting.T_vehicle_sonar;
  scan.line = std::move(waiting.line);
  output_(std::move(scan));
}

}  // namespace s2s::mapper
