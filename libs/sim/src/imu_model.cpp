#include "s2s/sim/imu_model.h"

namespace s2s::sim {

using Eigen::Vector3d;

namespace {

Vector3d normalVector(Random& random) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return {x, y, z};
}

}  // namespace

InertialTruth inertialTruth(const MotionState& s, const core::Isometry& T_vehicle_imu, double gravity_mps2) {
  const Vector3d lever = T_vehicle_imu.translation();
  const Vector3d& w = s.rate_body_radps;
  const Vector3d a_vehicle =
      s.T_world_vehicle.linear().transpose() * (s.acceleration_world_mps2 + gravity_mps2 * Vector3d::UnitZ()) +
      s.rateDerivative_body_radps2.cross(lever) + w.cross(w.cross(lever));
  const Eigen::Matrix3d R_imu_vehicle = T_vehicle_imu.linear().transpose();
  return {R_imu_vehicle * a_vehicle, R_imu_vehicle * w};
}

ImuModel::ImuModel(const ImuOptions& options, std::uint64_t seed) : options_(options), random_(seed, 0x696d75) {
  accBias_ = options.accBias_mps2 * normalVector(random_);
  gyroBias_ = options.gyroBias_radps * normalVector(random_);
  accScale_ = Vector3d::Ones() + options.accScale * normalVector(random_);
  gyroScale_ = Vector3d::Ones() + options.gyroScale * normalVector(random_);
}

mrpt::obs::CObservationIMU::Ptr ImuModel::sample(const VesselMotion& motion, double t_s, core::TimeNs time) {
  const ImuOptions& o = options_;
  InertialTruth truth = inertialTruth(motion.at(t_s), o.T_vehicle_imu, o.gravity_mps2);
  if (o.noise) {
    const double rootRate = std::sqrt(o.rate_hz);
    truth.force_mps2 = accScale_.cwiseProduct(truth.force_mps2) + accBias_ +
                       o.accNoiseDensity_mps2PerRtHz * rootRate * normalVector(random_);
    truth.rate_radps = gyroScale_.cwiseProduct(truth.rate_radps) + gyroBias_ +
                       o.gyroNoiseDensity_radpsPerRtHz * rootRate * normalVector(random_);
    accBias_ += o.accBiasWalk_mps3PerRtHz / rootRate * normalVector(random_);
    gyroBias_ += o.gyroBiasWalk_radps2PerRtHz / rootRate * normalVector(random_);
  }
  auto imu = mrpt::obs::CObservationIMU::Create();
  imu->timestamp = core::toMrptTime(time);
  imu->sensorLabel = o.label;
  imu->sensorPose = core::toPose(o.T_vehicle_imu);
  imu->set(mrpt::obs::IMU_X_ACC, truth.force_mps2.x());
  imu->set(mrpt::obs::IMU_Y_ACC, truth.force_mps2.y());
  imu->set(mrpt::obs::IMU_Z_ACC, truth.force_mps2.z());
  imu->set(mrpt::obs::IMU_WX, truth.rate_radps.x());
  imu->set(mrpt::obs::IMU_WY, truth.rate_radps.y());
  imu->set(mrpt::obs::IMU_WZ, truth.rate_radps.z());
  return imu;
}

}  // namespace s2s::sim
