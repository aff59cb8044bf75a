#include "aperture_association.h"

#include <cmath>
#include <optional>

#include "ping_motion.h"

namespace s2s::calib {

namespace {

constexpr int kAnchorStep = 8;        // steps of elevation between which ranges are interpolated
constexpr double kLeastSlope = 0.15;  // metres of height per metre of range: less grazes the bed
constexpr int kIterations = 6;
constexpr double kConverged_m = 0.002;
constexpr int kMembers = 4;  // of a profile stand for it

/// Elevation of an end as the state has it.
double endElevation(const SonarState& sonar, double bearing_rad, float end) {
  const auto& c = sonar.correction;
  const double half = 0.5 * sonar.aperture_rad + c[kWidth] + c[kWidthBend] * bearing_rad * bearing_rad;
  return static_cast<double>(end) * half + c[kAxis];
}

double meanOf(const std::vector<double>& values, double from, double to) {
  double sum = 0;
  int count = 0;
  for (int k = std::max(0, static_cast<int>(std::lround(from)));
       k <= std::min(static_cast<int>(values.size()) - 1, static_cast<int>(std::lround(to))); ++k) {
    sum += values[static_cast<std::size_t>(k)];
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

/// Where a profile that falls outward crosses the middle between the levels on its two sides, in steps.
std::optional<double> crossing(const std::vector<double>& profile, double ramp, double level, double minContrast) {
  const auto last = static_cast<double>(profile.size() - 1);
  double at = 0, most = 0;
  for (int k = static_cast<int>(std::ceil(ramp + level)); k <= static_cast<int>(last - ramp - level); ++k) {
    const double c = k;
    const double step = meanOf(profile, c - ramp - level, c - ramp) - meanOf(profile, c + ramp, c + ramp + level);
    if (step > most) most = step, at = c;
  }
  if (most <= 0) return {};
  for (int round = 0; round < 5; ++round) {
    const double half = 0.5 * level;
    const double farther = meanOf(profile, at - ramp - level, at - ramp - half),
                 nearer = meanOf(profile, at - ramp - half, at - ramp);
    const double inside = nearer + (nearer - farther) / half * (ramp + 0.5 * half);
    const double outside = meanOf(profile, at + ramp, at + ramp + level);
    if (inside < minContrast * outside) return {};
    const double middle = 0.5 * (inside + outside);
    double next = -1;
    for (int k = static_cast<int>(at - ramp); k < static_cast<int>(at + ramp); ++k) {
      const auto lower = static_cast<std::size_t>(k);
      const double here = profile[lower], there = profile[lower + 1];
      if (here < middle || there >= middle) continue;
      const double place = k + (here - middle) / (here - there);
      if (next < 0 || std::abs(place - at) < std::abs(next - at)) next = place;
    }
    if (next < ramp + level || next > last - ramp - level) return {};
    if (std::abs(next - at) < 0.01) return next;
    at = next;
  }
  return at;
}

}  // namespace

/// What a round knows, and the window around an end.
struct ApertureAssociation::Frame {
  const CalibrationState& state;
  const SeabedGrid &grid, &known;
  const ApertureOptions& options;
  int reach;  // steps to either side of an end

  const SonarState& sonar() const { return state[SonarId::Horizontal]; }
  int size() const { return 2 * reach + 1; }
  /// Elevation of a place of a profile.
  double elevation(double bearing_rad, float end, double step) const {
    return endElevation(sonar(), bearing_rad, end) + static_cast<double>(end) * (step - reach) * options.step_rad;
  }
  Eigen::Vector3d place(double bearing_rad, double range_m, double elevation_rad, const PingMotion& motion) const {
    const auto own = ownCorrection<double, 0>(sonar().correction.data(), {});
    const CorrectedBeam<double> beam(range_m, bearing_rad, sonar(), own.data(), state.soundSpeed_mps);
    return toMap<double>(toVehicle<double>(beamPoint<double>(beam, elevation_rad, sonar().model), sonar(), own.data()),
                         motion, own.data());
  }
  /// Where a ray meets the bed.
  struct Contact {
    double range_m = 4;  ///< as measured
    double height_m = 0;
  };
  /// Goes on from the place before. Where the bed is not known it may be taken as level from there on.
  std::optional<Contact> meet(double bearing_rad, double elevation_rad, const PingMotion& motion, const Contact& before,
                              bool mustBeKnown) const {
    const Eigen::Vector3d origin = place(bearing_rad, 0, elevation_rad, motion);
    const Eigen::Vector3d ray = place(bearing_rad, 1, elevation_rad, motion) - origin;
    Contact contact = before;
    for (int k = 0; k < kIterations; ++k) {
      const Eigen::Vector3d p = origin + contact.range_m * ray;
      const auto bed = known.at(p.x(), p.y()) ? grid.at(p.x(), p.y()) : std::nullopt;
      if (!bed && mustBeKnown) return {};
      contact.height_m = bed ? bed->height_m : before.height_m;
      const double gap_m = p.z() - contact.height_m;
      const double fall = (bed ? bed->slope.dot(ray.head<2>()) : 0) - ray.z();
      if (fall < kLeastSlope) return {};
      if (std::abs(gap_m) < kConverged_m) return contact;
      contact.range_m += gap_m / fall;
    }
    return mustBeKnown ? std::nullopt : std::optional(contact);
  }
};

/// False if the bed is not known up to the end.
bool ApertureAssociation::addStrip(const AperturePing& ping, const AperturePing::Strip& strip, Member member, float end,
                                   const Frame& frame, Profile& profile) const {
  const auto bearing = static_cast<double>(strip.bearing_rad);
  const double known = frame.reach + frame.options.ramp_rad / frame.options.step_rad;
  Frame::Contact contact;
  for (int step = 0; step < frame.size(); step += kAnchorStep) {
    const auto next = frame.meet(bearing, frame.elevation(bearing, end, step), *member.motion, contact, step <= known);
    if (!next || next->range_m < frame.options.minRange_m) return false;
    contact = *next;
    member.ranges_m.push_back(static_cast<float>(contact.range_m));
  }
  std::vector<float> values;
  for (int step = 0; step < frame.size(); ++step) {
    const auto anchor = static_cast<std::size_t>(std::min(step, frame.size() - 2) / kAnchorStep);
    const float u = static_cast<float>(step) / kAnchorStep - static_cast<float>(anchor);
    const float range_m = (1 - u) * member.ranges_m[anchor] + u * member.ranges_m[anchor + 1];
    const double bin = (static_cast<double>(range_m) - ping.firstRange_m) / ping.step_m;
    const auto lower = static_cast<std::size_t>(std::max(0.0, bin));
    if (lower + 1 >= strip.strength.size()) return false;
    const auto part = static_cast<float>(bin - static_cast<double>(lower));
    values.push_back((1 - part) * strip.strength[lower] + part * strip.strength[lower + 1]);
  }
  profile.sum.resize(values.size(), 0);
  for (std::size_t k = 0; k < values.size(); ++k) profile.sum[k] += static_cast<double>(values[k]);
  profile.members.push_back(std::move(member));
  return true;
}

void ApertureAssociation::add(const AperturePing& ping, const PingMotion& motion, const Frame& frame) {
  const double since_s = core::secondsBetween(evidence_.aperture.front().time, ping.time);
  const int block = static_cast<int>(std::floor(since_s / frame.options.stack_s));
  for (const auto& strip : ping.strips) {
    const int sector = static_cast<int>(std::floor(static_cast<double>(strip.bearing_rad) / frame.options.sector_rad));
    for (const int end : {-1, 1})
      addStrip(ping, strip, {&motion, ping.time, strip.bearing_rad, {}}, static_cast<float>(end), frame,
               profiles_[{block, sector, end}]);
  }
}

void ApertureAssociation::findEnd(const Profile& profile, float end, const Frame& frame) {
  if (profile.members.size() < static_cast<std::size_t>(frame.options.minProfiles)) return;
  const auto found = crossing(profile.sum, frame.options.ramp_rad / frame.options.step_rad,
                              frame.options.level_rad / frame.options.step_rad, frame.options.minContrast);
  if (!found) {
    ++leftOut_;
    return;
  }
  const auto anchor = static_cast<std::size_t>(*found) / kAnchorStep;
  const double u = *found / kAnchorStep - static_cast<double>(anchor);
  for (std::size_t n = 0; n < kMembers; ++n) {
    const Member& member = profile.members[(2 * n + 1) * profile.members.size() / (2 * kMembers)];
    const auto bearing = static_cast<double>(member.bearing_rad);
    const double range_m =
        (1 - u) * static_cast<double>(member.ranges_m[anchor]) + u * static_cast<double>(member.ranges_m[anchor + 1]);
    End result;
    result.time = member.time;
    result.off_rad = (*found - frame.reach) * frame.options.step_rad;
    const Echo echo{member.bearing_rad, static_cast<float>(range_m), EchoKind::ApertureEnd, end};
    const auto& correction = frame.sonar().correction;
    const Eigen::Vector3d p =
        echoPoint<double>(echo, frame.sonar(), *member.motion, correction.data(), frame.state.soundSpeed_mps);
    const auto bed = frame.grid.at(p.x(), p.y());
    if (!bed) continue;
    const double elevation = endElevation(frame.sonar(), bearing, end);
    const Eigen::Vector3d step = (frame.place(bearing, range_m, elevation + frame.options.step_rad, *member.motion) -
                                  frame.place(bearing, range_m, elevation, *member.motion)) /
                                 frame.options.step_rad;
    result.rise_mPerRad = std::abs(step.z() - bed->slope.dot(step.head<2>()));
    if (result.rise_mPerRad < kLeastSlope * range_m) continue;
    result.used.echo = echo;
    result.used.sonar = SonarId::Horizontal;
    result.used.kind = EvidenceKind::Aperture;
    result.used.motion = member.motion;
    result.used.cell = frame.grid.cellOf(p.x(), p.y());
    ends_.push_back(result);
  }
}

void ApertureAssociation::update(const CalibrationState& state, const SeabedGrid& grid, const SeabedGrid& known) {
  profiles_.clear();
  motions_.clear();
  ends_.clear();
  leftOut_ = 0;
  const ApertureOptions& o = options_.aperture;
  const int steps = static_cast<int>(std::lround(o.beyond_rad / o.step_rad));
  const Frame frame{state, grid, known, o, (steps + kAnchorStep - 1) / kAnchorStep * kAnchorStep};
  for (const AperturePing& ping : evidence_.aperture) {
    const auto motion = pingMotionAt(evidence_.T_map_vehicle, ping.time, state[SonarId::Horizontal]);
    if (!motion) continue;
    motions_.push_back(std::make_unique<PingMotion>(*motion));
    add(ping, *motions_.back(), frame);
  }
  for (const auto& [key, profile] : profiles_) findEnd(profile, static_cast<float>(std::get<2>(key)), frame);
  profiles_.clear();
}

}  // namespace s2s::calib
