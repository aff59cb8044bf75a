#include "s2s/graph/cloud_registration.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <nanoflann.hpp>

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

Eigen::Vector3f planeNormal(const Cloud& points, const std::uint32_t* indices, std::size_t count) {
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
  const bool plane = eigen.eigenvalues()[0] < kPlaneThickness * kPlaneThickness * eigen.eigenvalues()[1];
  return plane ? Eigen::Vector3f(eigen.eigenvectors().col(0).cast<float>()) : Eigen::Vector3f::Zero();
}

/// Normal equations of one iteration and what the partners look like.
struct Partners {
  core::Matrix6 H = core::Matrix6::Zero();
  core::Vector6 g = core::Vector6::Zero();
  Eigen::Matrix3d normals = Eigen::Matrix3d::Zero();
  double squares = 0;
  int count = 0;
};

Partners findPartners(const RegistrationTarget& target, const Cloud& source, const core::Isometry& T, double distance_m,
                      double scale_m, std::size_t stride) {
  Partners partners;
  RegistrationTarget::Plane plane;
  for (std::size_t p = 0; p < source.size(); p += stride) {
    const Eigen::Vector3d point = source[p].cast<double>();
    const Eigen::Vector3d moved = T * point;
    if (!target.nearestPlane(moved, distance_m, plane)) continue;
    const double residual = plane.normal.dot(moved - plane.point);
    core::Vector6 J;
    const Eigen::Vector3d n_source = T.linear().transpose() * plane.normal;
    J << n_source, point.cross(n_source);
    const double ratio = residual / scale_m;
    const double weight = 1 / ((1 + ratio * ratio) * (1 + ratio * ratio));
    partners.H += weight * J * J.transpose();
    partners.g += weight * residual * J;
    partners.normals += weight * plane.normal * plane.normal.transpose();
    partners.squares += residual * residual;
    ++partners.count;
  }
  return partners;
}

/// Share of the normals' information in the weakest direction.
double weakestShare(const Eigen::Matrix3d& normals) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(normals, Eigen::EigenvaluesOnly);
  return normals.trace() > 0 ? eigen.eigenvalues()[0] / normals.trace() : 0;
}

core::Matrix6 covarianceOf(const Partners& partners, const RegistrationOptions& options) {
  const double variance = std::max(partners.squares / std::max(partners.count, 1), 1e-4) * options.correlatedPoints;
  core::Matrix6 damped = partners.H;
  damped.diagonal().array() += 1e-9 * partners.H.trace();
  core::Matrix6 covariance = variance * damped.ldlt().solve(core::Matrix6::Identity());
  covariance.diagonal().head<3>().array() += options.floorTranslation_m * options.floorTranslation_m;
  covariance.diagonal().tail<3>().array() += options.floorRotation_rad * options.floorRotation_rad;
  return 0.5 * (covariance + covariance.transpose());
}

RegistrationStatus judge(const RegistrationResult& result, const RegistrationOptions& options) {
  if (result.overlap < options.minOverlap) return RegistrationStatus::tooFewPartners;
  if (result.rmse_m > options.maxRmse_m) return RegistrationStatus::residualTooLarge;
  if (result.constraint < options.minConstraint) return RegistrationStatus::degenerate;
  return RegistrationStatus::converged;
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
    normals_.push_back(found < 5 ? Eigen::Vector3f::Zero().eval() : planeNormal(points_, indices.data(), found));
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
    partners.H.diagonal().array() += 1e-6 * partners.H.trace() + 1e-9;
    const core::Vector6 step = -partners.H.ldlt().solve(partners.g);
    result.T_target_source.translate(Eigen::Vector3d(step.head<3>()));
    result.T_target_source.rotate(core::expSo3(step.tail<3>()));
    const bool settled = step.head<3>().norm() < 0.02 * distance_m && step.tail<3>().norm() < 0.002 * distance_m;
    if (fine && step.head<3>().norm() < 5e-4 && step.tail<3>().norm() < 5e-5) break;
    if (!fine && settled) distance_m = std::max(0.6 * distance_m, options.finePartner_m);
  }
  const Partners partners =
      findPartners(target, source, result.T_target_source, options.finePartner_m, options.residualScale_m, 1);
  result.overlap = static_cast<double>(partners.count) / static_cast<double>(source.size());
  result.rmse_m = partners.count > 0 ? std::sqrt(partners.squares / partners.count) : 0;
  result.constraint = weakestShare(partners.normals);
  result.covariance = covarianceOf(partners, options);
  result.status = judge(result, options);
  return result;
}

}  // namespace s2s::graph
