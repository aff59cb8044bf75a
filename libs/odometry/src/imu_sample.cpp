#include "s2s/odometry/imu_sample.h"

namespace s2s::odometry {

std::optional<ImuSample> imuSampleFrom(const mrpt::obs::CObservationIMU& observation) {
  using namespace mrpt::obs;
  constexpr std::array<TIMUDataIndex, 6> kAxes = {IMU_WX, IMU_WY, IMU_WZ, IMU_X_ACC, IMU_Y_ACC, IMU_Z_ACC};
  for (const auto axis : kAxes)
    if (!observation.has(axis)) return std::nullopt;
  ImuSample sample;
  sample.time = core::fromMrptTime(observation.timestamp);
  sample.angularRate_radps = {observation.get(IMU_WX), observation.get(IMU_WY), observation.get(IMU_WZ)};
  sample.specificForce_mps2 = {observation.get(IMU_X_ACC), observation.get(IMU_Y_ACC), observation.get(IMU_Z_ACC)};
  sample.T_vehicle_imu = core::toIsometry(observation.sensorPose);
  return sample;
}

}  // namespace s2s::odometry
