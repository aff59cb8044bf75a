#include "synthetic.h"

#include "s2s/odometry/scan_maker.h"

namespace s2s::odometry::synthetic {

using Eigen::Vector3d;

double Random::uniform() {
  state_ ^= state_ >> 12;
  state_ ^= state_ << 25;
  state_ ^= state_ >> 27;
  return static_cast<double>((state_ * 0x2545F4914F6CDD1DULL) >> 11) * 0x1.0p-53;
}

double Random::gaussian() {
  const double u = std::max(uniform(), 1e-300), v = uniform();
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * M_PI * v);
}

double World::cast(const Vector3d& origin, const Vector3d& direction) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& box : boxes) {
    const Eigen::Array3d a = (box.min - origin).array() / direction.array();
    const Eigen::Array3d b = (box.max - origin).array() / direction.array();
    const double enter = a.min(b).maxCoeff(), leave = a.max(b).minCoeff();
    if (leave < enter || leave <= 0) continue;
    nearest = std::min(nearest, enter > 0 ? enter : leave);
  }
  return nearest;
}

World room() {
  World world;
  world.boxes.push_back({{-10, -7, -1}, {10, 7, 7}});
  world.boxes.push_back({{4, 2, -1}, {6, 4, 2}});
  world.boxes.push_back({{-7, -5, -1}, {-5, -2, 1.5}});
  world.boxes.push_back({{-3, 4.5, -1}, {0, 7, 3}});
  world.boxes.push_back({{7, -6, -1}, {9, -4, 4}});
  return world;
}

World corridor() {
  World world;
  world.boxes.push_back({{-1e4, -4, -2}, {1e4, 4, 1e4}});
  return world;
}

World canal() {
  World world;
  for (const double side : {-1.0, 1.0}) {
    const auto add = [&](double x0, double x1, double near, double far, double z0, double z1) {
      const double y0 = side > 0 ? near : -far, y1 = side > 0 ? far : -near;
      world.boxes.push_back({{x0, y0, z0}, {x1, y1, z1}});
    };
    add(-100, 400, 12.5, 60, -5, 1.6);
    Random random(side > 0 ? 5 : 6);
    for (double x = -90; x < 380;) {
      const double width = 8 + 14 * random.uniform(), setback = 3 + 6 * random.uniform();
      add(x, x + width, 12.5 + setback, 40, 1.6, 6 + 12 * random.uniform());
      x += width + (random.uniform() < 0.3 ? 4.0 : 0.0);
    }
    for (double x = -40; x < 360; x += 47) add(x, x + 9, 9.6, 12.4, -1, 1.0 + random.uniform());
    for (const double x : {60.0, 200.0}) add(x, x + 3, 8.0, 10.0, -5, 5);
  }
  return world;
}

Path roomPath() {
  return [](double t) {
    return core::isometryFromXyzYpr(2.5 * std::sin(0.35 * t), 1.8 * std::sin(0.27 * t + 0.4),
                                    0.8 + 0.2 * std::sin(0.7 * t), 0.6 * std::sin(0.31 * t), 0.05 * std::sin(1.3 * t),
                                    0.08 * std::sin(1.1 * t + 1));
  };
}

Path cruise(double speed_mps, double y, double z) {
  return [=](double t) {
    return core::isometryFromXyzYpr(speed_mps * t, y + 0.5 * std::sin(0.2 * t), z + 0.05 * std::sin(1.9 * t),
                                    0.1 * std::sin(0.23 * t), 0.03 * std::sin(1.7 * t), 0.05 * std::sin(1.3 * t + 1));
  };
}

AcousticScan acousticAt(const Seabed& seabed, const Path& path, double t, double sigma_m, Random& random) {
  constexpr int kPoints = 600;
  const core::Isometry T_world_vehicle = path(t), T_vehicle_world = T_world_vehicle.inverse();
  AcousticScan scan;
  scan.time = timeOf(t);
  for (int i = 0; i < kPoints; ++i) {
    const Eigen::Vector3d ahead(2 + 3 * random.uniform(), 3 * (2 * random.uniform() - 1), 0);
    Eigen::Vector3d p = T_world_vehicle * ahead;
    p.z() = seabed(p.x(), p.y());
    scan.points_vehicle.emplace_back((T_vehicle_world * p + random.gaussian3(sigma_m)).cast<float>());
    scan.sigma_m.push_back(static_cast<float>(sigma_m));
  }
  return scan;
}

core::TimeNs timeOf(double t) { return 1'700'000'000 * core::kNsPerSecond + core::durationNs(t); }

ImuSample imuAt(const Path& path, double t, const core::Isometry& T_vehicle_imu, const ImuNoise& noise,
                Random& random) {
  // Central differences: the error is h^2/6 of a higher derivative, below 1e-6 here.
  constexpr double h = 1e-3;
  const core::Isometry before = path(t - h) * T_vehicle_imu, now = path(t) * T_vehicle_imu,
                       after = path(t + h) * T_vehicle_imu;
  const Vector3d acceleration = (after.translation() - 2 * now.translation() + before.translation()) / (h * h);
  ImuSample sample;
  sample.time = timeOf(t);
  sample.T_vehicle_imu = T_vehicle_imu;
  sample.angularRate_radps = core::logSo3(before.linear().transpose() * after.linear()) / (2 * h) + noise.gyroBias +
                             random.gaussian3(noise.gyro_radps);
  sample.specificForce_mps2 = now.linear().transpose() * (acceleration + Vector3d(0, 0, 9.81)) + noise.accelBias +
                              random.gaussian3(noise.accel_mps2);
  return sample;
}

obs::CObservationLidarSweep sweepAt(const World& world, const Path& path, double t, const Lidar& lidar,
                                    Random& random) {
  obs::CObservationLidarSweep sweep;
  sweep.timestamp = core::toMrptTime(timeOf(t));
  sweep.sensorLabel = "LIDAR";
  sweep.sensorPose = core::toPose(lidar.T_vehicle_sensor);
  sweep.rowCount = static_cast<std::uint32_t>(lidar.rows);
  sweep.columnCount = static_cast<std::uint32_t>(lidar.columns);
  sweep.echoes.resize(1);
  sweep.echoes[0].range.resize(sweep.pixelCount());
  sweep.echoes[0].reflectivity.assign(sweep.pixelCount(), 7);
  for (int row = 0; row < lidar.rows; ++row)
    sweep.beamAltitude_rad.push_back(static_cast<float>(lidar.highest_rad - (lidar.highest_rad - lidar.lowest_rad) *
                                                                                row / std::max(1, lidar.rows - 1)));
  for (int column = 0; column < lidar.columns; ++column) {
    sweep.columnAzimuth_rad.push_back(static_cast<float>(-2 * M_PI * column / lidar.columns));
    sweep.columnTime_ns.push_back(static_cast<std::int32_t>(1e9 * lidar.period_s * column / lidar.columns));
    const core::Isometry T = path(t + 1e-9 * sweep.columnTime_ns.back()) * lidar.T_vehicle_sensor;
    for (int row = 0; row < lidar.rows; ++row) {
      const double altitude = sweep.beamAltitude_rad[row], azimuth = sweep.columnAzimuth_rad[column];
      const Vector3d direction(std::cos(altitude) * std::cos(azimuth), std::cos(altitude) * std::sin(azimuth),
                               std::sin(altitude));
      const double range = world.cast(T.translation(), T.linear() * direction);
      if (range > lidar.maxRange_m) continue;
      const double noisy = range + lidar.rangeSigma_m * random.gaussian();
      sweep.echoes[0].range[row * sweep.columnCount + column] = static_cast<std::uint32_t>(std::lround(noisy * 1000));
    }
  }
  return sweep;
}

Scan scanAt(const World& world, const Path& path, double t, const Lidar& lidar, Random& random) {
  ScanOptions options;
  options.rowStride = options.columnStride = 1;
  return ScanMaker(options).fromSweep(sweepAt(world, path, t, lidar, random));
}

}  // namespace s2s::odometry::synthetic
