#include "s2s/graph/cloud_registration.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <nanoflann.hpp>

#include "s2s/odometry/registration.h"

namespace s2s::graph {

namespace {

/// How nanoflann sees a cloud.
struct CloudView {
  const Cloud& points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  float kdtree_get_pt(std::size_t p, std::size_t axis) const { return points[p][static_cast<Eigen::Index>(axis)]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};
using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, CloudView>, CloudView, 3>;

/// A surface is taken as a plane if its thickness is below this share of its width, both as standard deviations.
constexpr double kPlaneThickness = 0.25;

struct FittedPlane {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  double tiltVariance_rad2 = 0;
};

FittedPlane fitPlane(const Cloud& points, const std::uint32_t* indices, std::size_t count) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t n = 0; n < count; ++n) mean += points[indices[n]].cast<double>();
  mean /= static_cast<double>(count);
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (std::size_t n = 0; n < count; ++n) {
    const Eigen::Vector3d d = points[indices[n]].cast<double>() - mean;
    scatter += d * d.transpose();
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  eigen.computeDirect(scatter);
  const Eigen::Vector3d spread = eigen.eigenvalues().cwiseMax(0);
  FittedPlane plane;
  if (spread[0] >= kPlaneThickness * kPlaneThickness * spread[1]) return plane;
  plane.normal = eigen.eigenvectors().col(0).cast<float>();
  // Variance across the plane over the scatter along it, as for the slope of a fitted line.
  plane.tiltVariance_rad2 = spread[0] / static_cast<double>(count - 3) / spread[1];
  return plane;
}

/// Normal equations of one iteration and how the partners fit.
struct Partners {
  odometry::NormalEquations equations;
  double squares = 0;
};

void addPartner(const Eigen::Vector3d& point, const core::Isometry& T, const RegistrationTarget::Plane& plane,
                double scale_m, Partners& partners) {
  const double residual = plane.normal.dot(T * point - plane.point);
  const Eigen::Vector3d normal_source = T.linear().transpose() * plane.normal;
  Eigen::Matrix<double, 6, 3> byNormal;
  byNormal << Eigen::Matrix3d::Identity(), core::skew(point);
  const core::Vector6 h = byNormal * normal_source;
  const double ratio = residual / scale_m;
  const double weight = 1 / ((1 + ratio * ratio) * (1 + ratio * ratio));
  const Eigen::Matrix3d tangent = Eigen::Matrix3d::Identity() - normal_source * normal_source.transpose();
  partners.equations.A += weight * h * h.transpose();
  partners.equations.b += weight * residual * h;
  partners.equations.pretended += weight * plane.tiltVariance_rad2 * byNormal * tangent * byNormal.transpose();
  partners.equations.meanLever2_m2 += point.squaredNorm();
  partners.squares += residual * residual;
  ++partners.equations.matches;
}

Partners findPartners(const RegistrationTarget& target, const Cloud& source, const core::Isometry& T, double distance_m,
                      double scale_m, std::size_t stride) {
  Partners partners;
  RegistrationTarget::Plane plane;
  for (std::size_t p = 0; p < source.size(); p += stride) {
    const Eigen::Vector3d point = source[p].cast<double>();
    if (target.nearestPlane(T * point, distance_m, plane)) addPartner(point, T, plane, scale_m, partners);
  }
  partners.equations.meanLever2_m2 /= static_cast<double>(std::max<std::size_t>(partners.equations.matches, 1));
  return partners;
}

/// Gauss-Newton step in the directions that the equations determine, and no motion in the others.
core::Vector6 determinedStep(const odometry::NormalEquations& equations) {
  core::Matrix6 A = equations.A;
  A.diagonal().array() += 1e-9 * A.trace() + 1e-12;
  return -A.ldlt().solve(equations.b);
}

/// Inverse of the determined information, very wide where there is none.
core::Matrix6 covarianceOf(const Partners& partners, const RegistrationOptions& options) {
  constexpr double kUnknown_m = 10, kUnknown_rad = 0.3;
  const double count = static_cast<double>(std::max<std::size_t>(partners.equations.matches, 1));
  const double variance = std::max(partners.squares / count, 1e-4) * options.correlatedPoints;
  core::Matrix6 information = partners.equations.A / variance;
  information.diagonal().head<3>().array() += 1 / (kUnknown_m * kUnknown_m);
  information.diagonal().tail<3>().array() += 1 / (kUnknown_rad * kUnknown_rad);
  core::Matrix6 covariance = information.ldlt().solve(core::Matrix6::Identity());
  covariance.diagonal().head<3>().array() += options.floorTranslation_m * options.floorTranslation_m;
  covariance.diagonal().tail<3>().array() += options.floorRotation_rad * options.floorRotation_rad;
  return 0.5 * (covariance + covariance.transpose());
}

RegistrationStatus judge(const RegistrationResult& result, const RegistrationOptions& options) {
  if (result.overlap < options.minOverlap) return RegistrationStatus::tooFewPartners;
  if (result.rmse_m > options.maxRmse_m) return RegistrationStatus::residualTooLarge;
  if (result.degenerate > options.maxDegenerate) return RegistrationStatus::degenerate;
  return RegistrationStatus::converged;
}

/// Partners at the final pose: overlap, residuals, covariance and the verdict.
void judgeFit(const RegistrationTarget& target, const Cloud& source, const RegistrationOptions& options,
              RegistrationResult& result) {
  Partners partners =
      findPartners(target, source, result.T_target_source, options.finePartner_m, options.residualScale_m, 1);
  const auto count = static_cast<double>(partners.equations.matches);
  result.overlap = count / static_cast<double>(source.size());
  result.rmse_m = count > 0 ? std::sqrt(partners.squares / count) : 0;
  result.degenerate = static_cast<int>(odometry::removePretended(partners.equations, options.degeneracyRatio).size());
  result.covariance = covarianceOf(partners, options);
  result.status = judge(result, options);
}

}  // namespace

struct RegistrationTarget::Index {
  explicit Index(const Cloud& points) : view{points}, tree(3, view, nanoflann::KDTreeSingleIndexAdaptorParams(16)) {
    tree.buildIndex();
  }
  CloudView view;
  Tree tree;
};

RegistrationTarget::RegistrationTarget(const Cloud& points, const RegistrationOptions& options)
    : points_(voxelDownsample(points, options.voxel_m)) {
  if (points_.empty()) return;
  index_ = std::make_unique<Index>(points_);
  const auto neighbours = static_cast<std::size_t>(options.normalNeighbours);
  std::vector<std::uint32_t> indices(neighbours);
  std::vector<float> distances(neighbours);
  normals_.reserve(points_.size());
  for (const auto& point : points_) {
    const std::size_t found = index_->tree.knnSearch(point.data(), neighbours, indices.data(), distances.data());
    const FittedPlane plane = found < 5 ? FittedPlane() : fitPlane(points_, indices.data(), found);
    normals_.push_back(plane.normal);
    tiltVariances_rad2_.push_back(static_cast<float>(plane.tiltVariance_rad2));
  }
}

RegistrationTarget::~RegistrationTarget() = default;

bool RegistrationTarget::nearestPlane(const Eigen::Vector3d& query, double distance_m, Plane& plane) const {
  if (!index_) return false;
  const Eigen::Vector3f q = query.cast<float>();
  std::uint32_t nearest = 0;
  float squared = 0;
  if (index_->tree.knnSearch(q.data(), 1, &nearest, &squared) == 0) return false;
  if (squared > distance_m * distance_m || normals_[nearest].isZero()) return false;
  plane.point = points_[nearest].cast<double>();
  plane.normal = normals_[nearest].cast<double>();
  plane.tiltVariance_rad2 = tiltVariances_rad2_[nearest];
  return true;
}

RegistrationResult registerCloud(const RegistrationTarget& target, const Cloud& source,
                                 const core::Isometry& T_target_source_initial, const RegistrationOptions& options) {
  RegistrationResult result;
  result.T_target_source = T_target_source_initial;
  if (target.size() == 0 || source.empty()) return result;
  constexpr std::size_t kCoarsePoints = 800;
  double distance_m = options.coarsePartner_m;
  for (; result.iterations < options.maxIterations; ++result.iterations) {
    const bool fine = distance_m <= options.finePartner_m;
    const double scale_m = options.residualScale_m * distance_m / options.finePartner_m;
    const std::size_t stride = fine ? 1 : std::max<std::size_t>(1, source.size() / kCoarsePoints);
    Partners partners = findPartners(target, source, result.T_target_source, distance_m, scale_m, stride);
    odometry::removePretended(partners.equations, options.degeneracyRatio);
    const core::Vector6 step = determinedStep(partners.equations);
    result.T_target_source.translate(Eigen::Vector3d(step.head<3>()));
    result.T_target_source.rotate(core::expSo3(step.tail<3>()));
    const bool settled = step.head<3>().norm() < 0.02 * distance_m && step.tail<3>().norm() < 0.002 * distance_m;
    if (fine && step.head<3>().norm() < 5e-4 && step.tail<3>().norm() < 5e-5) break;
    if (!fine && settled) distance_m = std::max(0.6 * distance_m, options.finePartner_m);
  }
  judgeFit(target, source, options, result);
  return result;
}

}  // namespace s2s::graph
