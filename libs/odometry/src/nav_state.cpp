#include "s2s/odometry/nav_state.h"

namespace s2s::odometry {

NavState moved(const NavState& state, const ErrorVector& error) {
  NavState out = state;
  out.position += error.segment<3>(kPosition);
  out.R_odom_imu = state.R_odom_imu * core::expSo3(error.segment<3>(kRotation));
  out.velocity += error.segment<3>(kVelocity);
  out.gyroBias += error.segment<3>(kGyroBias);
  out.accelBias += error.segment<3>(kAccelBias);
  out.gravity += error.segment<3>(kGravity);
  out.floatingHeight += error[kFloating];
  out.timeOffset_s += error[kTimeOffset];
  out.R_imu_readings = core::expSo3(error.segment<3>(kMounting)) * state.R_imu_readings;
  return out;
}

ErrorVector errorBetween(const NavState& from, const NavState& to) {
  ErrorVector error;
  error.segment<3>(kPosition) = to.position - from.position;
  error.segment<3>(kRotation) = core::logSo3(from.R_odom_imu.transpose() * to.R_odom_imu);
  error.segment<3>(kVelocity) = to.velocity - from.velocity;
  error.segment<3>(kGyroBias) = to.gyroBias - from.gyroBias;
  error.segment<3>(kAccelBias) = to.accelBias - from.accelBias;
  error.segment<3>(kGravity) = to.gravity - from.gravity;
  error[kFloating] = to.floatingHeight - from.floatingHeight;
  error[kTimeOffset] = to.timeOffset_s - from.timeOffset_s;
  error.segment<3>(kMounting) = core::logSo3(to.R_imu_readings * from.R_imu_readings.transpose());
  return error;
}

}  // namespace s2s::odometry
