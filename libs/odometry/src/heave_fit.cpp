#include "s2s/odometry/heave_fit.h"

#include <Eigen/LU>

#include "s2s/odometry/inertial_filter.h"

namespace s2s::odometry {

namespace {

using Eigen::Vector3d;

/// Less than this share of the heave to be expected is not believed to be left beside the regular wave.
constexpr double kLeastHeaveShare = 0.2;
/// Speed of a heave for its size and correlation time.
constexpr double kSpeedPerHeave = 3.0;
/// Periods of the regular wave that are tried, each this factor longer than the last.
constexpr double kShortestWave_s = 0.8;
constexpr double kWaveStep = 1.08;

/// Floating height, speed, acceleration, and the regular wave's two amplitudes.
using Vector5 = Eigen::Matrix<double, 5, 1>;
using Matrix5 = Eigen::Matrix<double, 5, 5>;

struct Height {
  double t_s = 0, up_m = 0;
  /// Derivative of the irregular part of the heave by the unknowns.
  Vector5 row(double waveRate_radps) const {
    Vector5 row;
    row << -1.0, t_s, 0.5 * t_s * t_s, std::cos(waveRate_radps * t_s), std::sin(waveRate_radps * t_s);
    return row;
  }
};

/// Of the vehicle's origin, by the IMU alone from rest.
std::vector<Height> heightsFromRest(const NavState& start, const core::Isometry& T_imu_vehicle, const ImuBuffer& imu,
                                    core::TimeNs end, const OdometryOptions& options) {
  NavState rest = start;
  rest.velocity.setZero();
  InertialFilter filter(options.imu, options.motion, true);
  filter.reset(rest, ErrorMatrix::Zero());
  std::vector<NavState> path{rest};
  filter.propagate(imu.steps(start.time, end, options.imu.maxGap_s, start.timeOffset_s), &path);
  const Vector3d up = -start.gravity.normalized();
  std::vector<Height> heights;
  heights.reserve(path.size());
  for (const auto& state : path)
    heights.push_back(
        {core::secondsBetween(start.time, state.time), up.dot((state.T_odom_imu() * T_imu_vehicle).translation())});
  return heights;
}

struct Solution {
  Vector5 x = Vector5::Zero();
  Matrix5 covariance = Matrix5::Zero();
  double irregular_m = 0;  ///< root mean square of the heave beside the regular wave
};

/// Most probable unknowns for a period of the wave when the irregular heave has this deviation.
Solution solve(const std::vector<Height>& heights, double waveRate_radps, double irregular_m,
               const OdometryOptions& options) {
  const WaterOptions& water = options.water;
  // Neighbouring heights are the same heave: only so many count.
  const double independent = std::max(1.0, heights.back().t_s / water.heaveTime_s);
  const double weight = independent / (static_cast<double>(heights.size()) * irregular_m * irregular_m);
  Vector5 prior;
  prior << water.heaveSigma_m, kSpeedPerHeave * water.heaveSigma_m / water.heaveTime_s, options.imu.accelBiasSigma_mps2,
      water.heaveSigma_m, water.heaveSigma_m;
  Matrix5 A = prior.cwiseAbs2().cwiseInverse().asDiagonal();
  Vector5 b = Vector5::Zero();
  for (const auto& height : heights) {
    const Vector5 row = height.row(waveRate_radps);
    A.noalias() += weight * row * row.transpose();
    b -= weight * height.up_m * row;
  }
  Solution solution;
  solution.covariance = A.inverse();
  solution.x = solution.covariance * b;
  double squares = 0;
  for (const auto& height : heights) squares += std::pow(height.up_m + height.row(waveRate_radps).dot(solution.x), 2);
  solution.irregular_m = std::sqrt(squares / static_cast<double>(heights.size()));
  return solution;
}

}  // namespace

HeaveFit fitHeave(const NavState& start, const core::Isometry& T_imu_vehicle, const ImuBuffer& imu, core::TimeNs end,
                  const OdometryOptions& options) {
  const auto heights = heightsFromRest(start, T_imu_vehicle, imu, end, options);
  const double most = options.water.heaveSigma_m;
  Solution best;
  best.irregular_m = std::numeric_limits<double>::infinity();
  double bestRate = 0;
  const double longest_s = std::max(heights.back().t_s, 1.1 * kShortestWave_s);
  double period_s = kShortestWave_s;
  while (period_s < longest_s) {
    const double rate = 2 * M_PI / period_s;
    period_s *= kWaveStep;
    const Solution solution = solve(heights, rate, kLeastHeaveShare * most, options);
    if (solution.irregular_m >= best.irregular_m) continue;
    best = solution;
    bestRate = rate;
  }
  best = solve(heights, bestRate, std::clamp(best.irregular_m, kLeastHeaveShare * most, most), options);

  HeaveFit fit;
  fit.floatingHeight_m = best.x[0];
  fit.speed_mps = best.x[1];
  fit.acceleration_mps2 = best.x[2];
  fit.covariance = best.covariance.topLeftCorner<3, 3>();
  const double regular2 = 0.5 * best.x.tail<2>().squaredNorm();
  fit.heaveSigma_m = std::clamp(std::sqrt(regular2 + std::pow(best.irregular_m, 2)), kLeastHeaveShare * most, most);
  return fit;
}

}  // namespace s2s::odometry
