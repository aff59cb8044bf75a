#include "s2s/sim/vessel_motion.h"

#include <cmath>

namespace s2s::sim {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double kKnot_s = 0.25;  // spacing of the splines' control points
constexpr double kMaxDuration_s = 6 * 3600;

double wrapAngle(double a) { return std::remainder(a, 2 * M_PI); }

/// The planned way: follows the closest place forward only, so that crossings do not confuse it.
class PlannedWay {
 public:
  explicit PlannedWay(const std::vector<Vector2d>& points) : points_(points) {}

  /// The point `lookahead` further along the way than the vessel's own place on it.
  Vector2d target(const Vector2d& position, double lookahead_m) {
    while (leg_ + 2 < points_.size() && along(position) > length(leg_) - 0.5 * lookahead_m) ++leg_;
    double rest = along(position) + lookahead_m;
    std::size_t leg = leg_;
    while (leg + 2 < points_.size() && rest > length(leg)) rest -= length(leg++);
    return points_[leg] + rest * direction(leg);
  }
  bool finished(const Vector2d& position) const {
    return leg_ + 2 >= points_.size() && along(position) >= length(leg_);
  }

 private:
  Vector2d direction(std::size_t leg) const { return (points_[leg + 1] - points_[leg]).normalized(); }
  double length(std::size_t leg) const { return (points_[leg + 1] - points_[leg]).norm(); }
  double along(const Vector2d& p) const { return std::max(0.0, direction(leg_).dot(p - points_[leg_])); }

  std::vector<Vector2d> points_;
  std::size_t leg_ = 0;
};

/// Euler angles and their derivatives to body rates and their derivatives (Fossen 2011, eq. 2.26, with its sign
/// convention for a z-up body: the same formulas, as both are right-handed).
void setRates(MotionState& s, const Jet& yaw, const Jet& pitch, const Jet& roll) {
  const double sp = std::sin(pitch.value), cp = std::cos(pitch.value);
  const double sr = std::sin(roll.value), cr = std::cos(roll.value);
  s.rate_body_radps = {roll.first - yaw.first * sp, pitch.first * cr + yaw.first * sr * cp,
                       -pitch.first * sr + yaw.first * cr * cp};
  s.rateDerivative_body_radps2 = {roll.second - yaw.second * sp - yaw.first * pitch.first * cp,
                                  pitch.second * cr - pitch.first * roll.first * sr + yaw.second * sr * cp +
                                      yaw.first * (roll.first * cr * cp - pitch.first * sr * sp),
                                  -pitch.second * sr - pitch.first * roll.first * cr + yaw.second * cr * cp -
                                      yaw.first * (roll.first * sr * cp + pitch.first * cr * sp)};
}

}  // namespace

VesselMotion::VesselMotion(const Experiment& experiment, const VesselOptions& vessel, const WaveOptions& waves,
                           std::uint64_t seed)
    : waves_(waves, seed) {
  steer(experiment, vessel);
}

void VesselMotion::steer(const Experiment& experiment, const VesselOptions& o) {
  PlannedWay way(experiment.waypoints_m);
  Vector2d position = experiment.waypoints_m[0];
  const Vector2d firstLeg = experiment.waypoints_m[1] - position;
  double heading = std::atan2(firstLeg.y(), firstLeg.x()), yawRate = 0, speed = 0;
  constexpr int kStepsPerKnot = 25;
  constexpr double kStep_s = kKnot_s / kStepsPerKnot;
  int afterEnd = 0;
  for (int step = 0; step * kStep_s < kMaxDuration_s && afterEnd <= 4 * kStepsPerKnot; ++step) {
    if (step % kStepsPerKnot == 0) {
      x_.push_back(position.x());
      y_.push_back(position.y());
      heading_.push_back(heading);
    }
    if (afterEnd > 0 || way.finished(position)) {
      if (afterEnd++ == 0) duration_s_ = step * kStep_s;
    }
    const bool going = step * kStep_s >= o.startStill_s;
    const Vector2d aim = way.target(position, o.lookahead_m) - position;
    const double error = going ? wrapAngle(std::atan2(aim.y(), aim.x()) - heading) : 0;
    const double command = std::clamp(o.yawGain_perS * error, -o.maxYawRate_radps, o.maxYawRate_radps);
    const double turn = std::abs(yawRate) / o.maxYawRate_radps;
    const double wanted = going ? experiment.speed_mps * (1 - o.turnSlowdown * std::min(1.0, turn)) : 0;
    yawRate += kStep_s * (command - yawRate) / o.yawTimeConstant_s;
    speed += kStep_s * (wanted - speed) / o.speedTimeConstant_s;
    heading += kStep_s * yawRate;
    const Vector2d forward(std::cos(heading), std::sin(heading)), left(-forward.y(), forward.x());
    position += kStep_s * (speed * forward - o.drift_s * yawRate * speed * left);
  }
  if (duration_s_ == 0) duration_s_ = kMaxDuration_s;
}

Jet VesselMotion::spline(const std::vector<double>& controls, double t_s) const {
  // Uniform quintic B-spline; rows are the polynomial coefficients of the six basis pieces times 120.
  static constexpr double kBasis[6][6] = {{1, -5, 10, -10, 5, -1},  {26, -50, 20, 20, -20, 5},
                                          {66, 0, -60, 0, 30, -10}, {26, 50, 20, -20, -20, 10},
                                          {1, 5, 10, 10, 5, -5},    {0, 0, 0, 0, 0, 1}};
  const double position = t_s / kKnot_s;
  const auto first = static_cast<std::int64_t>(std::floor(position));
  const double u = position - static_cast<double>(first);
  Jet jet;
  for (int i = 0; i < 6; ++i) {
    const std::int64_t index =
        std::clamp<std::int64_t>(first + i - 2, 0, static_cast<std::int64_t>(controls.size()) - 1);
    const double c = controls[static_cast<std::size_t>(index)] / 120;
    const double* b = kBasis[i];
    jet.value += c * (b[0] + u * (b[1] + u * (b[2] + u * (b[3] + u * (b[4] + u * b[5])))));
    jet.first += c * (b[1] + u * (2 * b[2] + u * (3 * b[3] + u * (4 * b[4] + u * 5 * b[5]))));
    jet.second += c * (2 * b[2] + u * (6 * b[3] + u * (12 * b[4] + u * 20 * b[5])));
  }
  jet.first /= kKnot_s;
  jet.second /= kKnot_s * kKnot_s;
  return jet;
}

MotionState VesselMotion::at(double t_s) const {
  const Jet x = spline(x_, t_s), y = spline(y_, t_s), yaw = spline(heading_, t_s);
  const Jet heave = waves_.heave(t_s), roll = waves_.roll(t_s), pitch = waves_.pitch(t_s);
  MotionState s;
  s.T_world_vehicle = core::isometryFromXyzYpr(x.value, y.value, heave.value, yaw.value, pitch.value, roll.value);
  s.velocity_world_mps = {x.first, y.first, heave.first};
  s.acceleration_world_mps2 = {x.second, y.second, heave.second};
  setRates(s, yaw, pitch, roll);
  return s;
}

}  // namespace s2s::sim
