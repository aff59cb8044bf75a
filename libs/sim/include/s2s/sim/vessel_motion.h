#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "s2s/core/time.h"
#include "s2s/core/transform.h"
#include "s2s/sim/scene.h"

namespace s2s::sim {

struct VesselOptions {
  double startStill_s = 2;         ///< time at rest (but for the waves) before it gets going
  double lookahead_m = 4;          ///< line-of-sight guidance: aims at the point this far ahead on the planned way
  double yawTimeConstant_s = 0.8;  ///< Nomoto's T: the yaw rate follows the rudder with this lag
  double maxYawRate_radps = 0.45;
  double yawGain_perS = 0.7;  ///< commanded yaw rate per heading error
  double speedTimeConstant_s = 2.5;
  double turnSlowdown = 0.5;  ///< share of speed taken off in the sharpest turn
  double drift_s = 0.15;      ///< sway speed per yaw rate and forward speed: the stern skids outwards
};

struct WaveOptions {
  bool enabled = true;
  double significantHeight_m = 0.06;
  double peakPeriod_s = 1.9;
  int components = 24;
  double direction_rad = 0.6;  ///< the way the waves run, in the world
  double rollNaturalPeriod_s = 1.3;
  double rollDamping = 0.25;
  double slopeResponse = 0.5;  ///< roll and pitch per wave slope, far below the natural frequency
};

/// Pose and its derivatives at one time. World: z up; body: x forward, y left, z up.
struct MotionState {
  core::Isometry T_world_vehicle = core::Isometry::Identity();
  Eigen::Vector3d velocity_world_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration_world_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_body_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d rateDerivative_body_radps2 = Eigen::Vector3d::Zero();
};

/// A function of time with two derivatives.
struct Jet {
  double value = 0, first = 0, second = 0;
};

/// Sinusoids drawn from a wave spectrum (Pierson-Moskowitz in the form of Bretschneider, scaled to the significant
/// height), and the vessel's heave, roll and pitch under them.
class WaveMotion {
 public:
  WaveMotion(const WaveOptions& options, std::uint64_t seed);
  Jet heave(double t_s) const { return sum(t_s, &Component::heave_m, 0); }
  Jet roll(double t_s) const { return sum(t_s, &Component::roll_rad, 1.1); }
  Jet pitch(double t_s) const { return sum(t_s, &Component::pitch_rad, 2.0); }

 private:
  struct Component {
    double frequency_radps, phase_rad, heave_m, roll_rad, pitch_rad;
  };
  Jet sum(double t_s, double Component::*amplitude, double shift_rad) const;
  std::vector<Component> components_;
};

/// The vessel's true motion: a planned way followed with turning dynamics, waves on top, twice differentiable in
/// closed form everywhere.
///
/// A small simulation steers the vessel (line-of-sight guidance, Nomoto's first-order yaw dynamics); its positions and
/// headings every quarter second become the control points of quintic B-splines, and these splines are the truth.
class VesselMotion {
 public:
  VesselMotion(const Experiment& experiment, const VesselOptions& vessel, const WaveOptions& waves, std::uint64_t seed);

  /// Time until the last waypoint is reached.
  double duration_s() const { return duration_s_; }
  /// Exact at any time in [0, duration].
  MotionState at(double t_s) const;
  core::Isometry pose(double t_s) const { return at(t_s).T_world_vehicle; }

 private:
  void steer(const Experiment& experiment, const VesselOptions& options);
  Jet spline(const std::vector<double>& controls, double t_s) const;

  WaveMotion waves_;
  std::vector<double> x_, y_, heading_;
  double duration_s_ = 0;
};

}  // namespace s2s::sim
