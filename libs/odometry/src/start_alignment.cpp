#include "start_alignment.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>

#include "pretended.h"
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

/// Windows, as shares of the whole, and how much larger their voxels are: what is smeared at first needs room.
struct Window {
  double share, voxelGrowth;
};
constexpr Window kWindows[] = {{0.25, 2.0}, {0.5, 1.5}, {1.0, 1.0}};
constexpr int kMaxIterations = 10;
/// A step that moves the start by less than this share of its standard deviations ends the iterations.
constexpr double kSmallStep = 0.05;
constexpr double kCauchyWidth = 2.385;
constexpr double kMedianOfAbs = 0.6745;
constexpr double kLeastScale = 0.5;
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
  if (sizes.empty()) return 1.0;
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return std::max(kLeastScale, *middle / kMedianOfAbs);
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
    const double w = 1.0 / ((1.0 + r * r / (kCauchyWidth * kCauchyWidth * sigma2)) * sigma2 * layer.correlation);
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

/// Solves for the start in one window, beginning with the present one; false if the points do not suffice.
bool solve(const StartState& prior, const std::vector<StartLayer>& layers, double voxelGrowth,
           const std::vector<MotionStep>& steps, const OdometryOptions& options, NavState& start,
           Information& covariance) {
  const Information priorCovariance = prior.covariance.block<kUnknowns, kUnknowns>(kVelocity, kVelocity);
  const Information priorInformation =
      (priorCovariance + kLeastVariance * Information::Identity()).ldlt().solve(Information::Identity());
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const Motion motion(start, steps, options);
    Information A = priorInformation;
    Unknowns b = priorInformation * errorBetween(prior.state, start).segment<kUnknowns>(kVelocity);
    std::size_t points = 0;
    for (const auto& layer : layers) {
      const Equations seen = equationsOf(layer, motion, voxelGrowth);
      // Each on its own: what one sensor pretends to know must not hide what another knows.
      const auto known =
          withoutPretended<kUnknowns>(seen.A, seen.b, seen.pretended, options.registration.degeneracyRatio);
      A += known.A;
      b += known.b;
      points += seen.points;
    }
    if (points < kLeastPoints) return false;
    covariance = A.ldlt().solve(Information::Identity());
    const Unknowns step = -covariance * b;
    ErrorVector error = ErrorVector::Zero();
    error.segment<kUnknowns>(kVelocity) = step;
    start = moved(start, error);
    if (step.cwiseAbs().cwiseQuotient(covariance.diagonal().cwiseSqrt()).maxCoeff() < kSmallStep) break;
  }
  return true;
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
  const double whole_s = core::secondsBetween(prior.state.time, end);
  StartState start = prior;
  Information covariance = Information::Zero();
  bool isSolved = false;
  for (const auto& window : kWindows) {
    const core::TimeNs until = prior.state.time + core::durationNs(window.share * whole_s);
    const auto steps = imu.steps(prior.state.time, until, options.imu.maxGap_s, prior.state.timeOffset_s);
    isSolved = solve(prior, layers, window.voxelGrowth, steps, options, start.state, covariance);
  }
  if (!isSolved) return std::nullopt;
  covariance += imuNoise(whole_s, options.imu).asDiagonal();
  start.covariance.block<kUnknowns, kUnknowns>(kVelocity, kVelocity) = covariance;
  return levelled(start);
}

}  // namespace s2s::odometry
