#pragma once

#include "s2s/obs/CObservationLidarSweep.h"
#include "s2s/sim/lidar_effects.h"
#include "s2s/sim/random.h"
#include "s2s/sim/ray_caster.h"
#include "s2s/sim/vessel_motion.h"

namespace s2s::sim {

/// A spinning multi-beam LiDAR. Defaults: Ouster OS1-64 on a mast.
struct LidarOptions {
  bool enabled = true;
  std::string label = "LIDAR";
  core::Isometry T_vehicle_sensor = core::isometryFromXyzYpr(0.22, 0, 1.05, 0, 0, 0);  ///< nominal
  int rows = 64, columns = 1024;
  double rate_hz = 10;
  double verticalFov_rad = 45 * M_PI / 180;
  double minRange_m = 0.5, maxRange_m = 120;

  LidarEffects effects;
};

/// Casts each column from the vessel's pose at the column's own time. Safe to use from many threads.
class LidarModel {
 public:
  /// `scene` and `caster` must outlive the model.
  /// @param T_vehicle_sensor the true mounting; the options hold the nominal one, which the sweeps carry
  LidarModel(const LidarOptions& options, const core::Isometry& T_vehicle_sensor, const Scene& scene,
             const RayCaster& caster, std::uint64_t seed);

  /// The sweep with the given number, whose first column is fired at t_s of the motion's clock.
  obs::CObservationLidarSweep::Ptr sweep(const VesselMotion& motion, double t_s, core::TimeNs time,
                                         std::uint32_t number) const;

 private:
  struct Column;
  void makeDirections();
  void findOwnVessel();
  void makeRays(const core::Isometry& T_world_sensor, std::size_t column, Column& work) const;
  void findEchoes(std::size_t column, Random& random, Column& work) const;
  void addWater(Random& random, Column& work) const;
  void mixAtEdges(Random& random, Column& work) const;

  LidarOptions options_;
  core::Isometry T_vehicle_sensor_;
  const Scene& scene_;
  const RayCaster& caster_;
  std::uint64_t seed_;
  obs::CObservationLidarSweep prototype_;    // tables that all sweeps share
  std::vector<Eigen::Vector3d> origins_;     // of each column's beams, sensor frame
  std::vector<Eigen::Vector3d> directions_;  // of each beam, column by column, sensor frame
  std::vector<LidarEcho> ownVessel_;         // per pixel, nearest part of the vessel itself
};

/// "64x1024@10": rows, columns, sweeps a second.
/// @throws core::ConfigError if the text is not of this form
void parseLidarMode(const std::string& text, LidarOptions& options);

}  // namespace s2s::sim
