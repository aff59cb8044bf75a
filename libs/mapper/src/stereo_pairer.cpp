#include "s2s/mapper/stereo_pairer.h"

#include <cstdlib>
#include <limits>

#include "s2s/map/sonar_scans.h"

namespace s2s::mapper {

namespace {

/// A vertical ping does not wait longer than this for a horizontal sonar that has fallen silent.
constexpr double kPatience_s = 1.0;

/// Waits for the image of a ping; null if there is none.
std::shared_ptr<const sonar::ProcessedPing> imageOf(const PendingPing& ping) {
  try {
    return ping.image.get();
  } catch (const std::future_error&) {
    return nullptr;
  }
}

}  // namespace

StereoPairer::StereoPairer(const sonar::SonarOptions& options, double window_s, Motion motion)
    : stereo_(options.horizontal, options.vertical, options.stereo),
      window_(core::durationNs(window_s)),
      motion_(std::move(motion)) {}

std::vector<StereoScan> StereoPairer::add(PendingPing ping) {
  const core::TimeNs time = ping.time;
  const bool isHorizontal = ping.role == Role::SonarHorizontal;
  (isHorizontal ? horizontal_ : vertical_).push_back(std::move(ping));
  // Corrected times of the two sonars may come out of order, so only the horizontal sonar's own tell what may yet come.
  return pairUntil(isHorizontal ? time : time - core::durationNs(kPatience_s));
}

std::vector<StereoScan> StereoPairer::finish() { return pairUntil(std::numeric_limits<core::TimeNs>::max()); }

std::vector<StereoScan> StereoPairer::pairUntil(core::TimeNs newest) {
  std::vector<StereoScan> scans;
  while (!vertical_.empty() && newest - window_ > vertical_.front().time) {
    if (const PendingPing* partner = nearestHorizontal(vertical_.front().time)) {
      auto scan = fuse(*partner, vertical_.front());
      if (!scan.points.empty()) scans.push_back(std::move(scan));
    }
    vertical_.pop_front();
  }
  // Without a vertical ping at hand, one of up to a moment ago may still come.
  const core::TimeNs oldest = vertical_.empty() ? newest - core::durationNs(kPatience_s) : vertical_.front().time;
  while (!horizontal_.empty() && horizontal_.front().time < oldest - window_) horizontal_.pop_front();
  return scans;
}

const PendingPing* StereoPairer::nearestHorizontal(core::TimeNs time) const {
  const PendingPing* nearest = nullptr;
  core::TimeNs smallest = window_ + 1;
  for (const PendingPing& ping : horizontal_) {
    const core::TimeNs gap = std::abs(ping.time - time);
    if (gap >= smallest) continue;
    smallest = gap;
    nearest = &ping;
  }
  return nearest;
}

StereoScan StereoPairer::fuse(const PendingPing& horizontal, const PendingPing& vertical) {
  StereoScan scan;
  scan.time = horizontal.time;
  const auto h = imageOf(horizontal), v = imageOf(vertical);
  if (!h || !v) return scan;
  const core::Isometry T_h_v =
      horizontal.T_vehicle_sonar.inverse() * motion_(horizontal.time, vertical.time) * vertical.T_vehicle_sonar;
  scan.points = map::toScanPoints(stereo_.process(*h, *v, T_h_v).points, horizontal.T_vehicle_sonar);
  return scan;
}

}  // namespace s2s::mapper
