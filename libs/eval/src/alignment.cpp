#include "s2s/eval/alignment.h"

#include <mrpt/core/exceptions.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <cmath>

namespace s2s::eval {

namespace {

using Points = std::vector<Eigen::Vector3d>;

Eigen::Vector3d centroid(const Points& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

/// The rotation R that maximises tr(R^T H), for H = sum of target * source^T.
Eigen::Matrix3d rotationFromCorrelation(const Eigen::Matrix3d& H) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(H, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d sign(1, 1, 1);
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) sign.z() = -1;
  return svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
}

/// Root-mean-square extent of points along their best line and distance from it.
void measureLine(const Points& points, const Eigen::Vector3d& centre, double& along_m, double& off_m) {
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const auto& p : points) scatter += (p - centre) * (p - centre).transpose();
  scatter /= static_cast<double>(points.size());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scatter, Eigen::EigenvaluesOnly);
  const Eigen::Vector3d values = eigen.eigenvalues().cwiseMax(0);
  along_m = std::sqrt(values(2));
  off_m = std::sqrt(values(0) + values(1));
}

core::Isometry assemble(const Eigen::Matrix3d& R, const Eigen::Vector3d& source, const Eigen::Vector3d& target) {
  core::Isometry T = core::Isometry::Identity();
  T.linear() = R;
  T.translation() = target - R * source;
  return T;
}

}  // namespace

PointAlignment alignPoints(const Points& source, const Points& target) {
  ASSERT_EQUAL_(source.size(), target.size());
  PointAlignment result;
  if (source.empty()) return result;
  const Eigen::Vector3d s0 = centroid(source), t0 = centroid(target);
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < source.size(); ++i) H += (target[i] - t0) * (source[i] - s0).transpose();
  result.T_target_source = assemble(rotationFromCorrelation(H), s0, t0);

  double sum = 0;
  for (std::size_t i = 0; i < source.size(); ++i) sum += (result.T_target_source * source[i] - target[i]).squaredNorm();
  result.rmse_m = std::sqrt(sum / static_cast<double>(source.size()));

  double targetAlong_m = 0, targetOff_m = 0;
  measureLine(source, s0, result.alongLine_m, result.offLine_m);
  measureLine(target, t0, targetAlong_m, targetOff_m);
  const auto collinear = [](double along_m, double off_m) { return off_m <= kCollinearShare * along_m; };
  if (source.size() < 3)
    result.status = AlignmentStatus::TooFewPoints;
  else if (collinear(result.alongLine_m, result.offLine_m) || collinear(targetAlong_m, targetOff_m))
    result.status = AlignmentStatus::Collinear;
  else
    result.status = AlignmentStatus::Ok;
  return result;
}

core::Isometry alignPoses(const std::vector<core::Isometry>& source, const std::vector<core::Isometry>& target,
                          double lever_m) {
  ASSERT_EQUAL_(source.size(), target.size());
  ASSERT_(!source.empty() && lever_m > 0);
  Points s, t;
  s.reserve(4 * source.size());
  t.reserve(4 * target.size());
  for (std::size_t i = 0; i < source.size(); ++i) {
    s.emplace_back(source[i].translation());
    t.emplace_back(target[i].translation());
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d tip = lever_m * Eigen::Vector3d::Unit(axis);
      s.emplace_back(source[i] * tip);
      t.emplace_back(target[i] * tip);
    }
  }
  return alignPoints(s, t).T_target_source;
}

}  // namespace s2s::eval
