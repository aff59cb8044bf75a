#include "synthetic_survey.h"

namespace s2s::graph::test {

namespace {

core::Isometry poseOnRectangle(double s, double length_m, double width_m) {
  const double round = 2 * (length_m + width_m);
  s = std::fmod(s, round);
  double x = 0, y = 0, yaw = 0;
  if (s < length_m) {
    x = s;
  } else if (s < length_m + width_m) {
    x = length_m, y = s - length_m, yaw = M_PI / 2;
  } else if (s < 2 * length_m + width_m) {
    x = length_m - (s - length_m - width_m), y = width_m, yaw = M_PI;
  } else {
    y = width_m - (s - 2 * length_m - width_m), yaw = -M_PI / 2;
  }
  // A slow roll and pitch, so that the path is no plane problem.
  return core::isometryFromXyzYpr(x, y, 0.05 * std::sin(0.3 * s), yaw, 0.02 * std::sin(0.2 * s),
                                  0.03 * std::sin(0.15 * s));
}

}  // namespace

SyntheticSurvey makeLaps(int laps, double length_m, double width_m, unsigned seed) {
  FixedRandom random(seed);
  SyntheticSurvey survey;
  const double sigma_m = 0.005, sigma_rad = 0.0005;
  survey.stepCovariance = diagonalCovariance(sigma_m, sigma_rad);
  const double total = laps * 2 * (length_m + width_m);
  for (double s = 0; s < total; s += 1) {
    survey.truth.push_back(poseOnRectangle(s, length_m, width_m));
    if (survey.odometry.empty()) {
      survey.odometry.push_back(survey.truth.back());
      continue;
    }
    const core::Isometry step = survey.truth[survey.truth.size() - 2].inverse() * survey.truth.back();
    survey.odometry.push_back(survey.odometry.back() * perturbed(step, random.normal6(sigma_m, sigma_rad)));
  }
  return survey;
}

KeyframeInput keyframeInput(const SyntheticSurvey& survey, std::size_t k) {
  KeyframeInput input;
  input.time = core::durationNs(1000.0 + static_cast<double>(k));
  input.T_odom_vehicle = survey.odometry[k];
  input.motionCovariance = survey.stepCovariance;
  return input;
}

double rmsError_m(const GraphSlam& slam, const SyntheticSurvey& survey) {
  double sum = 0;
  for (const auto& keyframe : slam.keyframes())
    sum += (keyframe.T_map_vehicle.translation() - survey.truth[static_cast<std::size_t>(keyframe.id)].translation())
               .squaredNorm();
  return std::sqrt(sum / static_cast<double>(slam.keyframes().size()));
}

void SyntheticTown::addWall(const Eigen::Vector3d& corner, const Eigen::Vector3d& along, double height_m,
                            FixedRandom& random) {
  const int count = static_cast<int>(along.norm() * height_m * 5);  // points per square metre
  for (int n = 0; n < count; ++n)
    points_map_.push_back(corner + random.uniform(0, 1) * along + Eigen::Vector3d(0, 0, random.uniform(0, height_m)));
}

void SyntheticTown::addGround(const Eigen::Vector3d& corner, const Eigen::Vector3d& u, const Eigen::Vector3d& v,
                              FixedRandom& random) {
  const int count = static_cast<int>(u.norm() * v.norm() * 3);
  for (int n = 0; n < count; ++n) points_map_.push_back(corner + random.uniform(0, 1) * u + random.uniform(0, 1) * v);
}

SyntheticTown::SyntheticTown(double length_m, double width_m, unsigned seed) {
  FixedRandom random(seed);
  // Houses of random size left and right of the rectangle's sides.
  const auto addHouse = [&](double x, double y) {
    const double a = random.uniform(3, 9), b = random.uniform(3, 9), height_m = random.uniform(3, 12);
    const double turn = random.uniform(-0.4, 0.4);
    const Eigen::Vector3d u(a * std::cos(turn), a * std::sin(turn), 0), v(-b * std::sin(turn), b * std::cos(turn), 0);
    const Eigen::Vector3d corner(x, y, 0);
    addWall(corner, u, height_m, random);
    addWall(corner, v, height_m, random);
    addWall(corner + u, v, height_m, random);
    addWall(corner + v, u, height_m, random);
    addGround(corner - 0.3 * u - 0.3 * v, 1.6 * u, 1.6 * v, random);
  };
  for (const double offset_m : {-16.0, 8.0}) {
    for (double x = -10; x < length_m + 10; x += random.uniform(10, 18)) {
      addHouse(x, offset_m);
      addHouse(x, width_m + offset_m);
    }
    for (double y = 20; y < width_m - 20; y += random.uniform(10, 18)) {
      addHouse(offset_m, y);
      addHouse(length_m + offset_m, y);
    }
  }
}

Cloud SyntheticTown::scan(const core::Isometry& T_map_vehicle, double range_m, FixedRandom& random) const {
  const core::Isometry T_vehicle_map = T_map_vehicle.inverse();
  Cloud cloud;
  for (const auto& point : points_map_) {
    if ((point - T_map_vehicle.translation()).squaredNorm() > range_m * range_m) continue;
    cloud.emplace_back((T_vehicle_map * point + random.normal3(0.01)).cast<float>());
  }
  return cloud;
}

}  // namespace s2s::graph::test
