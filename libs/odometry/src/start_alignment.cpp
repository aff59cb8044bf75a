#include "start_alignment.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>

#include "pretended.h"
#include "robust.h"
#include "s2s/odometry/downsample.h"
#include "voxel_key.h"

namespace s2s::odometry {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// What the start does not know, in the error's order: velocity, biases of gyro and accelerometer, gravity.
constexpr int kUnknowns = 12;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
using Information = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using ByUnknowns = Eigen::Matrix<double, 3, kUnknowns>;

/// Shares of the window, and how much larger their voxels are: what is smeared at first needs room.
struct Stage {
  double share, voxelGrowth;
};
constexpr Stage kStages[] = {{0.25, 2.0}, {0.5, 1.5}, {1.0, 1.0}};
/// Speeds ahead that are tried beside the assumed one: from one standard deviation astern to two ahead, in steps from
/// which the right one is still found.
constexpr double kSpeedStep_mps = 1.0, kSpeedStepSigma_mps = 0.5, kMostSpeedSigmas = 2.0;
/// So many times more points on planes make a speed believed against the assumed one; solutions that are the same but
/// for where the iterations began differ by up to half a percent.
constexpr double kTellingSupport = 1.005;
constexpr int kMaxIterations = 10;
/// A step that moves the start by less than this share of its standard deviations ends the iterations.
constexpr double kSmallStep = 0.05;
/// Points on planes below which a window tells nothing, returns on a plane of a LiDAR, and the most that are looked at.
constexpr std::size_t kLeastPoints = 200;
constexpr int kLidarPointsOfPlane = 8;
constexpr std::size_t kMostLidarPoints = 30000;
/// Keeps a prior invertible that knows something exactly.
constexpr double kLeastVariance = 1e-12;

/// Motion of the window that follows from a start, and its derivatives with respect to the unknowns.
class Motion {
 public:
  Motion(const NavState& start, const std::vector<MotionStep>& steps, const OdometryOptions& options) {
    Eigen::Matrix<double, kErrorSize, kUnknowns> by = Eigen::Matrix<double, kErrorSize, kUnknowns>::Zero();
    by.middleRows<kUnknowns>(kVelocity).setIdentity();
    nodes_.push_back({start, by.topRows<6>()});
    for (const auto& step : steps) {
      const StepModel model = propagated(nodes_.back().state, step, options.imu, options.motion, true);
      by = (model.F * by).eval();
      nodes_.push_back({model.state, by.topRows<6>()});
    }
  }

  /// Place of a point in odom and its derivative; false outside the window.
  bool place(const StartPoint& point, Vector3d& place, ByUnknowns& derivative) const {
    const auto after = std::upper_bound(nodes_.begin(), nodes_.end(), point.time,
                                        [](core::TimeNs time, const Node& node) { return time < node.state.time; });
    if (after == nodes_.begin() || after == nodes_.end()) return false;
    const Node& a = *std::prev(after);
    const Node& b = *after;
    const double u = core::secondsBetween(a.state.time, point.time) / core::secondsBetween(a.state.time, b.state.time);
    place = (1 - u) * (a.state.T_odom_imu() * point.p_imu) + u * (b.state.T_odom_imu() * point.p_imu);
    const Node& nearest = u < 0.5 ? a : b;
    derivative =
        nearest.pose.topRows<3>() - nearest.state.R_odom_imu * core::skew(point.p_imu) * nearest.pose.bottomRows<3>();
    return true;
  }

 private:
  struct Node {
    NavState state;
    Eigen::Matrix<double, 6, kUnknowns> pose;  // of position and rotation
  };
  std::vector<Node> nodes_;
};

/// A layer's points where the present start puts them.
struct Placed {
  std::vector<Vector3d> places;
  std::vector<ByUnknowns> derivatives;
  std::vector<double> variances;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> byVoxel;  // sorted
};

Placed placed(const StartLayer& layer, const Motion& motion, double voxel_m) {
  Placed out;
  Vector3d place;
  ByUnknowns derivative;
  for (const auto& point : layer.points) {
    if (!motion.place(point, place, derivative)) continue;
    out.byVoxel.emplace_back(voxelKey(place / voxel_m), static_cast<std::uint32_t>(out.places.size()));
    out.places.push_back(place);
    out.derivatives.push_back(derivative);
    out.variances.push_back(point.variance_m2);
  }
  std::sort(out.byVoxel.begin(), out.byVoxel.end());
  return out;
}

/// One voxel's plane and its points' residuals.
struct Patch {
  std::vector<std::uint32_t> points;
  Vector3d mean = Vector3d::Zero(), normal = Vector3d::Zero();
  Eigen::Matrix<double, 3, 2> along;  // axes in the plane
  Eigen::Vector2d spread_m2;          // sum of squares along each
  double residual(const Vector3d& p) const { return normal.dot(p - mean); }
};

std::vector<Patch> patchesOf(const Placed& placed, int minPoints) {
  std::vector<Patch> patches;
  for (std::size_t begin = 0, end = 0; begin < placed.byVoxel.size(); begin = end) {
    while (end < placed.byVoxel.size() && placed.byVoxel[end].first == placed.byVoxel[begin].first) ++end;
    if (end - begin < static_cast<std::size_t>(minPoints)) continue;
    Patch patch;
    for (std::size_t i = begin; i < end; ++i) patch.points.push_back(placed.byVoxel[i].second);
    for (const auto i : patch.points) patch.mean += placed.places[i] / static_cast<double>(patch.points.size());
    Matrix3d scatter = Matrix3d::Zero();
    for (const auto i : patch.points) {
      const Vector3d d = placed.places[i] - patch.mean;
      scatter += d * d.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(scatter);
    // What is as thick as it is wide has no normal.
    if (4 * solver.eigenvalues()[0] > solver.eigenvalues()[1]) continue;
    patch.normal = solver.eigenvectors().col(0);
    patch.along = solver.eigenvectors().rightCols<2>();
    patch.spread_m2 = solver.eigenvalues().tail<2>();
    patches.push_back(std::move(patch));
  }
  return patches;
}

double residualScale(const Placed& placed, const std::vector<Patch>& patches) {
  std::vector<double> sizes;
  for (const auto& patch : patches) {
    // The plane takes three of the points' degrees of freedom.
    const auto n = static_cast<double>(patch.points.size());
    const double free = std::sqrt(n / (n - 3));
    for (const auto i : patch.points)
      sizes.push_back(free * std::abs(patch.residual(placed.places[i])) / std::sqrt(placed.variances[i]));
  }
  return std::max(kLeastScale, robustScale(sizes));
}

struct Equations {
  Information A = Information::Zero(), pretended = Information::Zero();
  Unknowns b = Unknowns::Zero();
  std::size_t points = 0;
};

/// Information of points about the unknowns by their distances along one direction, when an offset and two tilts of the
/// plane that they lie on are unknown, too.
class Eliminated {
 public:
  void add(double w, double r, const Unknowns& a, const Vector3d& byPlane) {
    A_ += w * a * a.transpose();
    b_ += w * r * a;
    mixed_ += w * byPlane * a.transpose();
    plane_ += w * byPlane * byPlane.transpose();
    planeResidual_ += w * r * byPlane;
  }
  Information information() const { return A_ - mixed_.transpose() * plane_.ldlt().solve(mixed_); }
  Unknowns rightSide() const { return b_ - mixed_.transpose() * plane_.ldlt().solve(planeResidual_); }

 private:
  Information A_ = Information::Zero();
  Unknowns b_ = Unknowns::Zero();
  ByUnknowns mixed_ = ByUnknowns::Zero();
  Matrix3d plane_ = Matrix3d::Zero();
  Vector3d planeResidual_ = Vector3d::Zero();
};

void addPatch(const StartLayer& layer, const Placed& points, const Patch& patch, double scale, Equations& sum) {
  Eliminated across, along0, along1;
  double variance_m2 = 0;
  for (const auto i : patch.points) {
    const double sigma2 = scale * scale * points.variances[i];
    const double r = patch.residual(points.places[i]);
    const double w = cauchyWeight(r, sigma2) / (sigma2 * layer.correlation);
    const Eigen::Vector2d at = patch.along.transpose() * (points.places[i] - patch.mean);
    const Vector3d byPlane(1, at.x(), at.y());
    const ByUnknowns& J = points.derivatives[i];
    across.add(w, r, J.transpose() * patch.normal, byPlane);
    along0.add(w, 0, J.transpose() * patch.along.col(0), byPlane);
    along1.add(w, 0, J.transpose() * patch.along.col(1), byPlane);
    variance_m2 += sigma2;
  }
  const auto count = static_cast<double>(patch.points.size());
  const double tilt = variance_m2 / count * (1 + layer.shapeShare * count);
  sum.A += across.information();
  sum.b += across.rightSide();
  sum.pretended +=
      tilt / patch.spread_m2.x() * along0.information() + tilt / patch.spread_m2.y() * along1.information();
  sum.points += patch.points.size();
}

/// A layer's information, its planes eliminated.
Equations equationsOf(const StartLayer& layer, const Motion& motion, double voxelGrowth) {
  const Placed points = placed(layer, motion, voxelGrowth * layer.voxel_m);
  const auto patches = patchesOf(points, layer.minPoints);
  const double scale = residualScale(points, patches);
  Equations sum;
  for (const auto& patch : patches) addPatch(layer, points, patch, scale, sum);
  return sum;
}

/// Noise of the IMU within the window, which the motion from the start leaves out, as errors of the start.
Unknowns imuNoise(double duration_s, const ImuOptions& imu) {
  const double velocity2 = imu.accelNoise_mps2_rthz * imu.accelNoise_mps2_rthz * duration_s;
  const double rate2 = imu.gyroNoise_radps_rthz * imu.gyroNoise_radps_rthz / duration_s;
  const double force2 = imu.accelNoise_mps2_rthz * imu.accelNoise_mps2_rthz / duration_s;
  Unknowns noise;
  noise << Vector3d::Constant(velocity2), Vector3d::Constant(rate2), Vector3d::Constant(force2), Vector3d::Zero();
  return noise;
}

/// What is known of a start, and the data that improve it.
struct Window {
  const ImuBuffer& imu;
  core::TimeNs end;
  const std::vector<StartLayer>& layers;
  const OdometryOptions& options;

  std::vector<MotionStep> steps(const NavState& start, double share) const {
    const double whole_s = core::secondsBetween(start.time, end);
    return imu.steps(start.time, start.time + core::durationNs(share * whole_s), options.imu.maxGap_s,
                     start.timeOffset_s);
  }
};

struct Solution {
  NavState start;
  Information covariance = Information::Zero();
};

/// Improves the start by a stage's share of the window; false if the points do not suffice.
bool solve(const StartState& prior, const Window& window, const Stage& stage, Solution& solution) {
  const OdometryOptions& options = window.options;
  const auto steps = window.steps(prior.state, stage.share);
  const Information priorCovariance = prior.covariance.block<kUnknowns, kUnknowns>(kVelocity, kVelocity);
  const Information priorInformation =
      (priorCovariance + kLeastVariance * Information::Identity()).ldlt().solve(Information::Identity());
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const Motion motion(solution.start, steps, options);
    Information A = priorInformation;
    Unknowns b = priorInformation * errorBetween(prior.state, solution.start).segment<kUnknowns>(kVelocity);
    std::size_t points = 0;
    for (const auto& layer : window.layers) {
      const Equations seen = equationsOf(layer, motion, stage.voxelGrowth);
      // Each on its own: what one sensor pretends to know must not hide what another knows.
      const auto known =
          withoutPretended<kUnknowns>(seen.A, seen.b, seen.pretended, options.registration.degeneracyRatio);
      A += known.A;
      b += known.b;
      points += seen.points;
    }
    if (points < kLeastPoints) return false;
    solution.covariance = A.ldlt().solve(Information::Identity());
    const Unknowns step = -solution.covariance * b;
    ErrorVector error = ErrorVector::Zero();
    error.segment<kUnknowns>(kVelocity) = step;
    solution.start = moved(solution.start, error);
    if (step.cwiseAbs().cwiseQuotient(solution.covariance.diagonal().cwiseSqrt()).maxCoeff() < kSmallStep) break;
  }
  return true;
}

std::optional<Solution> solveFrom(const StartState& prior, const Window& window) {
  Solution solution{prior.state, Information::Zero()};
  bool isSolved = false;
  for (const Stage& stage : kStages) isSolved = solve(prior, window, stage, solution);
  if (!isSolved) return std::nullopt;
  return solution;
}

/// How many points a start puts on planes, those off their plane counted less.
double support(const NavState& start, const Window& window) {
  const Motion motion(start, window.steps(start, 1.0), window.options);
  double sum = 0;
  for (const auto& layer : window.layers) {
    const Placed points = placed(layer, motion, layer.voxel_m);
    for (const auto& patch : patchesOf(points, layer.minPoints))
      for (const auto i : patch.points) sum += cauchyWeight(patch.residual(points.places[i]), points.variances[i]);
  }
  return sum;
}

std::vector<double> speedsAhead(const WaterOptions& water) {
  std::vector<double> speeds{-water.speedSigma_mps};
  while (speeds.back() + kSpeedStep_mps <= kMostSpeedSigmas * water.speedSigma_mps)
    speeds.push_back(speeds.back() + kSpeedStep_mps);
  return speeds;
}

/// The same belief for a vessel that makes this speed ahead.
StartState underWay(const StartState& prior, double speed_mps, const core::Isometry& T_vehicle_imu) {
  StartState start = prior;
  const Vector3d up = -prior.state.gravity.normalized();
  const Vector3d ahead = prior.state.R_odom_imu * T_vehicle_imu.linear().transpose() * Vector3d::UnitX();
  start.state.velocity = up * up.dot(prior.state.velocity) + speed_mps * (ahead - up * up.dot(ahead));
  auto covariance = start.covariance.block<3, 3>(kVelocity, kVelocity);
  const double verticalVariance = up.dot(prior.covariance.block<3, 3>(kVelocity, kVelocity) * up);
  covariance = kSpeedStepSigma_mps * kSpeedStepSigma_mps * Matrix3d::Identity();
  covariance += (verticalVariance - kSpeedStepSigma_mps * kSpeedStepSigma_mps) * up * up.transpose();
  return start;
}

}  // namespace

StartLayer lidarLayer(const std::deque<Scan>& scans, core::TimeNs end, const core::Isometry& T_vehicle_imu,
                      const OdometryOptions& options) {
  const RegistrationOptions& registration = options.registration;
  StartLayer layer;
  layer.voxel_m = options.map.voxel_m * static_cast<double>(1 << (std::max(options.map.levels, 1) - 1));
  layer.minPoints = kLidarPointsOfPlane;
  layer.correlation = registration.correlation;
  layer.shapeShare = options.map.shapeShare;
  for (const Scan& scan : scans) {
    if (scan.endTime() > end) break;
    const core::Isometry T_imu_sensor = T_vehicle_imu.inverse() * scan.T_vehicle_sensor;
    for (const auto i : onePerCube(scan.points_sensor, registration.scanVoxel_m)) {
      const core::TimeNs time = scan.offset_s.empty() ? scan.endTime() : scan.time + core::durationNs(scan.offset_s[i]);
      const Vector3d p = scan.points_sensor[i].cast<double>();
      const double across_m = registration.angleSigma_rad * p.norm();
      layer.points.push_back(
          {time, T_imu_sensor * p, registration.rangeSigma_m * registration.rangeSigma_m + across_m * across_m});
    }
  }
  const std::size_t stride = 1 + layer.points.size() / kMostLidarPoints;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < layer.points.size(); i += stride) layer.points[kept++] = layer.points[i];
  layer.points.resize(kept);
  return layer;
}

StartLayer seabedLayer(const std::vector<AcousticScan>& scans, const core::Isometry& T_vehicle_imu,
                       const OdometryOptions& options) {
  const SeabedOptions& seabed = options.seabed;
  StartLayer layer;
  layer.voxel_m = seabed.map.voxel_m;
  layer.minPoints = seabed.map.minPoints;
  layer.correlation = seabed.correlation;
  layer.shapeShare = seabed.map.shapeShare;
  const core::Isometry T_imu_vehicle = T_vehicle_imu.inverse();
  for (const auto& scan : scans)
    for (const auto i : onePerCube(scan.points_vehicle, seabed.pointVoxel_m)) {
      const double sigma_m = std::max<double>(scan.sigma_m[i], seabed.leastSigma_m);
      layer.points.push_back({scan.time, T_imu_vehicle * scan.points_vehicle[i].cast<double>(), sigma_m * sigma_m});
    }
  return layer;
}

std::optional<StartState> alignedStart(const StartState& prior, const ImuBuffer& imu, core::TimeNs end,
                                       const std::vector<StartLayer>& layers, const OdometryOptions& options) {
  const Window window{imu, end, layers, options};
  const core::Isometry& T_vehicle_imu = imu.samples().front().T_vehicle_imu;
  std::optional<Solution> best = solveFrom(prior, window);
  double most = best ? kTellingSupport * support(best->start, window) : 0;
  for (const double speed : speedsAhead(options.water)) {
    const auto found = solveFrom(underWay(prior, speed, T_vehicle_imu), window);
    if (!found) continue;
    const double sum = support(found->start, window);
    if (sum <= most) continue;
    best = found;
    most = sum;
  }
  if (!best) return std::nullopt;
  StartState start = prior;
  start.state = best->start;
  start.covariance.block<kUnknowns, kUnknowns>(kVelocity, kVelocity) = best->covariance;
  const Unknowns noise = imuNoise(core::secondsBetween(prior.state.time, end), options.imu);
  start.covariance.block<kUnknowns, kUnknowns>(kVelocity, kVelocity) += noise.asDiagonal();
  return levelled(start);
}

}  // namespace s2s::odometry
