#include "s2s/graph/cloud_registration.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <nanoflann.hpp>

#include "point_to_plane.h"

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
  double tiltVariance_rad2 = 0, variance_m2 = 0;
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
  plane.variance_m2 = spread[0] / static_cast<double>(count - 3);
  plane.tiltVariance_rad2 = plane.variance_m2 / spread[1];
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
  const double ratio = residual / scale_m;
  const double weight = 1 / ((1 + ratio * ratio) * (1 + ratio * ratio));
  addPointToPlane(point, T.linear().transpose() * plane.normal, residual, weight, plane.tiltVariance_rad2,
                  partners.equations);
  partners.squares += residual * residual;
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

core::Matrix6 covarianceOf(const Partners& partners, const RegistrationOptions& options) {
  const double count = static_cast<double>(std::max<std::size_t>(partners.equations.matches, 1));
  const double variance = std::max(partners.squares / count, 1e-4) * options.correlatedPoints;
  core::Vector6 floorSigma;
  floorSigma << Eigen::Vector3d::Constant(options.floorTranslation_m),
      Eigen::Vector3d::Constant(options.floorRotation_rad);
  return covarianceFrom(partners.equations.A / variance, floorSigma);
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
    : points_(options.voxel_m > 0 ? voxelDownsample(points, options.voxel_m) : points) {
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
    variances_m2_.push_back(static_cast<float>(plane.variance_m2));
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
  plane.variance_m2 = variances_m2_[nearest];
  plane.index = nearest;
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
    applyStep(step, result.T_target_source);
    const bool settled = step.head<3>().norm() < 0.02 * distance_m && step.tail<3>().norm() < 0.002 * distance_m;
    if (fine && step.head<3>().norm() < 5e-4 && step.tail<3>().norm() < 5e-5) break;
    if (!fine && settled) distance_m = std::max(0.6 * distance_m, options.finePartner_m);
  }
  judgeFit(target, source, options, result);
  return result;
}

}  // namespace s2s::graph
