#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "s2s/obs/CObservationLidarSweep.h"
#include "s2s/odometry/acoustic_scan.h"
#include "s2s/odometry/imu_sample.h"
#include "s2s/odometry/scan.h"

/// A small world of boxes and a vessel on a smooth path, both known exactly.
namespace s2s::odometry::synthetic {

/// Uniform and Gaussian numbers that are the same with every standard library (xorshift64*, Box-Muller).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 2654435769ULL + 88172645463325252ULL) {}
  double uniform();
  double gaussian();
  Eigen::Vector3d gaussian3(double sigma) { return {sigma * gaussian(), sigma * gaussian(), sigma * gaussian()}; }

 private:
  std::uint64_t state_;
};

struct Box {
  Eigen::Vector3d min, max;
};

/// Solid boxes; one that holds the sensor is a room seen from inside.
struct World {
  std::vector<Box> boxes;
  /// Distance to the nearest surface along a unit direction; infinity if there is none.
  double cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;
};

/// 20 m x 14 m x 8 m with furniture: all directions well seen.
World room();
/// Two parallel walls and a floor without end: nothing tells the way along x.
World corridor();
/// A canal along x, 300 m x 25 m: quays, houses of several depths, bridge piers.
World canal();

/// T_world_vehicle as a function of seconds.
using Path = std::function<core::Isometry(double)>;
/// Gentle motion inside `room`.
Path roomPath();
/// Along x at a speed [m/s], rolling and pitching like a small vessel.
Path cruise(double speed_mps, double y, double z);

struct ImuNoise {
  double gyro_radps = 0, accel_mps2 = 0;  // per sample
  Eigen::Vector3d gyroBias = Eigen::Vector3d::Zero(), accelBias = Eigen::Vector3d::Zero();
};

/// Exact reading at a time (by differences of the path), with noise.
ImuSample imuAt(const Path& path, double t, const core::Isometry& T_vehicle_imu, const ImuNoise& noise, Random& random);

struct Lidar {
  int rows = 32, columns = 256;
  double lowest_rad = -0.39, highest_rad = 0.39;
  double period_s = 0.1;
  double rangeSigma_m = 0.01, maxRange_m = 120;
  core::Isometry T_vehicle_sensor = core::isometryFromXyzYpr(0.1, 0, 0.9, 0.05, 0, 0);
};

/// A sweep starting at `t`, each column from the pose of its moment.
obs::CObservationLidarSweep sweepAt(const World& world, const Path& path, double t, const Lidar& lidar, Random& random);
/// The same as a scan with all returns.
Scan scanAt(const World& world, const Path& path, double t, const Lidar& lidar, Random& random);

/// Height of a seabed [m] as a function of x and y.
using Seabed = std::function<double(double, double)>;

/// What two sonars see of a seabed ahead of the vessel: points of 2 to 5 m ahead and 3 m to both sides, with isotropic
/// noise.
AcousticScan acousticAt(const Seabed& seabed, const Path& path, double t, double sigma_m, Random& random);

/// Time zero of the synthetic records.
core::TimeNs timeOf(double t);

}  // namespace s2s::odometry::synthetic
