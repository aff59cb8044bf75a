#pragma once

#include <mrpt/obs/CObservationGPS.h>

#include "s2s/sim/random.h"
#include "s2s/sim/vessel_motion.h"

namespace s2s::sim {

/// A single-frequency GNSS receiver (u-blox NEO-M8): white noise on a slowly wandering error.
struct GnssOptions {
  bool enabled = true;
  std::string label = "GNSS";
  double rate_hz = 1;
  core::Isometry T_vehicle_antenna = core::isometryFromXyzYpr(-0.35, 0, 0.8, 0, 0, 0);
  double noise_m = 0.3;       ///< white, per horizontal axis; heights are twice as bad
  double wander_m = 1.0;      ///< standard deviation of the wandering part ...
  double wanderTime_s = 120;  ///< ... and its correlation time
  double originLatitude_deg = 55.6617, originLongitude_deg = 12.5736, originHeight_m = 0;  ///< of the world's origin
};

/// Fixes at the antenna: the world frame is taken as east-north-up at the origin (WGS84 ellipsoid).
class GnssModel {
 public:
  GnssModel(const GnssOptions& options, std::uint64_t seed);

  /// The next fix; call once for each in time order, as the error wanders.
  /// @param offset_world_m added to the position: what a spoofer makes of it
  mrpt::obs::CObservationGPS::Ptr fix(const VesselMotion& motion, double t_s, core::TimeNs time,
                                      const Eigen::Vector3d& offset_world_m = Eigen::Vector3d::Zero());

 private:
  GnssOptions options_;
  Random random_;
  Eigen::Vector3d wander_m_ = Eigen::Vector3d::Zero();
};

}  // namespace s2s::sim
