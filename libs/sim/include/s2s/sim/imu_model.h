#pragma once

#include <mrpt/obs/CObservationIMU.h>

#include "s2s/sim/random.h"
#include "s2s/sim/vessel_motion.h"

namespace s2s::sim {

/// Errors of an inertial sensor in the terms of an Allan-deviation table. Defaults: the unit inside an Ouster OS1
/// (TDK ICM-20948 data sheet: 0.015 deg/s/rtHz, 230 ug/rtHz).
struct ImuOptions {
  std::string label = "IMU";
  double rate_hz = 100;
  bool noise = true;  ///< false: exact derivatives of the motion
  double accNoiseDensity_mps2PerRtHz = 2.3e-3;
  double gyroNoiseDensity_radpsPerRtHz = 2.6e-4;
  double accBias_mps2 = 0.05;  ///< standard deviation of the bias at switch-on, per axis
  double gyroBias_radps = 0.003;
  double accBiasWalk_mps3PerRtHz = 3e-4;  ///< random walk of the bias
  double gyroBiasWalk_radps2PerRtHz = 2e-5;
  double accScale = 2e-3;  ///< standard deviation of the scale error, per axis
  double gyroScale = 2e-3;
  double gravity_mps2 = 9.81;
  core::Isometry T_vehicle_imu = core::isometryFromXyzYpr(0.214, -0.012, 1.057, 0, 0, 0);
};

/// Specific force and turn rate of the moving vessel at the sensor's place, with noise, bias, bias walk and scale.
class ImuModel {
 public:
  ImuModel(const ImuOptions& options, std::uint64_t seed);

  /// The next sample; call once for each sample in time order, as the bias walks.
  /// @param t_s time on the motion's clock
  mrpt::obs::CObservationIMU::Ptr sample(const VesselMotion& motion, double t_s, core::TimeNs time);

 private:
  ImuOptions options_;
  Random random_;
  Eigen::Vector3d accBias_, gyroBias_, accScale_, gyroScale_;
};

/// Specific force [m/s^2] and turn rate [rad/s] that a perfect sensor mounted at T_vehicle_imu feels, in its own frame.
struct InertialTruth {
  Eigen::Vector3d force_mps2, rate_radps;
};
InertialTruth inertialTruth(const MotionState& state, const core::Isometry& T_vehicle_imu, double gravity_mps2);

}  // namespace s2s::sim
