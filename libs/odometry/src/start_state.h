#pragma once

#include "s2s/odometry/imu_buffer.h"
#include "s2s/odometry/inertial_filter.h"
#include "s2s/odometry/options.h"

namespace s2s::odometry {

/// A filter's first belief.
struct StartState {
  NavState state;
  ErrorMatrix covariance = ErrorMatrix::Zero();
  double heaveSigma_m = 0;  ///< of the heave that the IMU felt; 0: not known
  bool isStatic = false;    ///< the vehicle lies still at first
  /// The scans of a rehearsal left the speed in some direction open, and with it all that would follow from it. A
  /// vessel is then taken to lie about still, unless the speed learnt is no such speed.
  bool isSpeedOpen = false;
};

/// First belief with an IMU: up is the mean specific force from `start` to `end`, rotated back to `start` by the gyro.
/// If the IMU feels no motion at first, only that rest counts: the gyro's bias is its mean reading, and the speed is
/// zero; in motion both are open.
StartState inertialStart(const ImuBuffer& imu, core::TimeNs start, core::TimeNs end, const OdometryOptions& options);

/// First belief without IMU.
StartState lidarOnlyStart(core::TimeNs start, const OdometryOptions& options);

/// An IMU feels rest and even motion alike: a first belief of rest, with the speed left open.
StartState inEvenMotion(const StartState& atRest, const OdometryOptions& options);

/// Whether a belief that was refined by scans holds a speed that cannot be zero.
bool deniesRest(const StartState& start);

/// Improves a first belief by what the filter knew when it had run once over the first scans: gravity and biases from
/// its end, the speed from early on, where less of the way back to the start has to be reckoned.
StartState refinedStart(const StartState& rough, const InertialFilter& early, const InertialFilter& rehearsed,
                        const ImuBuffer& imu, const OdometryOptions& options);

/// The belief that a registration of all first scans begins with: of a blind rehearsal only the speed that is assumed,
/// as what else it says follows from a speed that was wrong.
StartState beforeAlignment(const StartState& rough, const StartState& refined);

/// The same belief in a frame whose z axis points up.
StartState levelled(const StartState& start);

/// Rotation whose z axis is `up_body` seen from the body, and whose x axis is the body's heading.
Eigen::Matrix3d levelRotation(const Eigen::Vector3d& up_body);

}  // namespace s2s::odometry
