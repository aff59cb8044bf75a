#include "s2s/odometry/registration.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>

#include "pretended.h"
#include "robust.h"

namespace s2s::odometry {

namespace {

using core::Matrix6;
using core::Vector6;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Least share of an unknown motion that may show in directions that are seen.
constexpr double kUnseenLeak = 0.01;
/// Singular values below this are noise of the directions, and the cosine above which two directions are the same.
constexpr double kLeastSingular = 0.3, kSame = 0.9;
/// The share of the prior in the kernel's width falls by this from one iteration to the next.
constexpr double kPriorFade = 0.1;

struct Residual {
  Vector6 h;
  double r = 0;              // [m]
  double priorVariance = 0;  // of the residual, from the prior
  double sigma_m = 0;        // expected
  Vector3d p;                // in the body
  double tiltVariance = 0;
};

/// Residuals of all points with a plane whose distance is possible under the prior and the noise.
std::vector<Residual> residualsAt(const BodyPoints& points, const PlaneMap& map, const core::Isometry& T,
                                  const Matrix6& priorCovariance, const RegistrationOptions& options) {
  std::vector<Residual> residuals;
  residuals.reserve(points.points_body.size());
  const Matrix3d R = T.linear(), Rt = R.transpose();
  PlaneMatch plane;
  for (std::size_t i = 0; i < points.points_body.size(); ++i) {
    const Vector3d& p = points.points_body[i];
    if (!map.match(R * p + T.translation(), plane)) continue;
    Residual residual;
    residual.h << plane.normal, p.cross(Rt * plane.normal);
    residual.r = plane.distance_m;
    const double variance = points.variance_m2[i] + plane.variance_m2;
    residual.priorVariance = residual.h.dot(priorCovariance * residual.h);
    const double gate2 = options.gateSigma * options.gateSigma * (variance + residual.priorVariance);
    if (residual.r * residual.r > gate2) continue;
    residual.sigma_m = std::sqrt(variance);
    residual.p = p;
    residual.tiltVariance = plane.tiltVariance_rad2;
    residuals.push_back(residual);
  }
  return residuals;
}

/// Robust scale of the residuals over their expected standard deviations.
double residualScale(const std::vector<Residual>& residuals) {
  std::vector<double> sizes;
  sizes.reserve(residuals.size());
  for (const auto& residual : residuals) sizes.push_back(std::abs(residual.r) / residual.sigma_m);
  return robustScale(sizes);
}

/// Sum of v G (1 - n n^T) G^T over all residuals, v = w times tilt variance and G = dh/dn = (1, [p]x R^T); as
/// (G n) = h, it splits into sums that need not the normal, and one of h h^T.
class PretendedSum {
 public:
  void add(const Residual& residual, double w) {
    const double v = w * residual.tiltVariance;
    weight_ += v;
    first_ += v * residual.p;
    second_.noalias() += (v * residual.p) * residual.p.transpose();
    outer_.noalias() += (v * residual.h) * residual.h.transpose();
  }
  Matrix6 matrix(const Matrix3d& R) const {
    Matrix6 sum = -outer_;
    sum.topLeftCorner<3, 3>() += weight_ * Matrix3d::Identity();
    const Matrix3d cross = core::skew(first_) * R.transpose();
    sum.bottomLeftCorner<3, 3>() += cross;
    sum.topRightCorner<3, 3>() += cross.transpose();
    sum.bottomRightCorner<3, 3>() += second_.trace() * Matrix3d::Identity() - second_;
    return sum;
  }
  double meanLever2_m2() const { return weight_ > 0 ? second_.trace() / weight_ : 1.0; }

 private:
  double weight_ = 0;
  Vector3d first_ = Vector3d::Zero();
  Matrix3d second_ = Matrix3d::Zero();
  Matrix6 outer_ = Matrix6::Zero();
};

/// Orthonormal basis of motions, in coordinates scaled by `scale`.
Eigen::MatrixXd basisOf(const std::vector<Vector6>& motions, const Vector6& scale) {
  Eigen::MatrixXd columns(6, static_cast<Eigen::Index>(motions.size()));
  for (std::size_t i = 0; i < motions.size(); ++i)
    columns.col(static_cast<Eigen::Index>(i)) = scale.cwiseProduct(motions[i]).stableNormalized();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(columns, Eigen::ComputeThinU);
  return svd.matrixU().leftCols((svd.singularValues().array() > kLeastSingular).count());
}

Vector6 differenceFrom(const core::Isometry& prior, const core::Isometry& T) {
  Vector6 e;
  e << T.translation() - prior.translation(), core::logSo3(prior.linear().transpose() * T.linear());
  return e;
}

void moveBy(const Vector6& step, core::Isometry& T) {
  T.translation() += step.head<3>();
  T.linear() = (T.linear() * core::expSo3(step.tail<3>())).eval();
}

}  // namespace

NormalEquations linearise(const BodyPoints& points, const PlaneMap& map, const core::Isometry& T,
                          const Matrix6& priorCovariance, double priorShare, const RegistrationOptions& options) {
  const auto residuals = residualsAt(points, map, T, priorCovariance, options);
  NormalEquations sum;
  sum.matches = residuals.size();
  sum.residualScale = residualScale(residuals);
  const double scale = std::max(kLeastScale, sum.residualScale);
  PretendedSum pretended;
  for (const auto& residual : residuals) {
    const double sigma = scale * residual.sigma_m;
    const double kernel = cauchyWeight(residual.r, sigma * sigma + priorShare * residual.priorVariance);
    const double w = kernel / (sigma * sigma * options.correlation);
    sum.priorRatio = std::max(sum.priorRatio, residual.priorVariance / (sigma * sigma));
    const Vector6 wh = w * residual.h;
    sum.A.noalias() += wh * residual.h.transpose();
    sum.b += residual.r * wh;
    pretended.add(residual, w);
  }
  sum.pretended = pretended.matrix(T.linear());
  // The directions are eigenvectors of sums over planes whose normals are off independently.
  const double tilt2 =
      sum.pretended.topLeftCorner<3, 3>().trace() / std::max(1e-12, sum.A.topLeftCorner<3, 3>().trace());
  sum.unseenLeak2 = options.degeneracyRatio * tilt2 * options.correlation / std::max<double>(1, sum.matches);
  sum.meanLever2_m2 = pretended.meanLever2_m2();
  return sum;
}

std::vector<Vector6> removePretended(NormalEquations& equations, double ratio) {
  const Known<6> known = withoutPretended<6>(equations.A, equations.b, equations.pretended, ratio);
  std::vector<Vector6> unseen;
  for (int i = 0; i < 6; ++i) {
    if (known.known[i] > 0) continue;
    const Vector6 motion = known.V.col(i);
    const double size2 = motion.head<3>().squaredNorm() + equations.meanLever2_m2 * motion.tail<3>().squaredNorm();
    unseen.emplace_back(motion / std::sqrt(size2));
  }
  equations.A = known.A;
  equations.b = known.b;
  return unseen;
}

void allowForUnseen(const std::vector<Vector6>& unseen, const Matrix6& priorCovariance, NormalEquations& equations) {
  const double lever2 = std::max(1.0, equations.meanLever2_m2);
  Vector6 metric;
  metric << Vector3d::Ones(), Vector3d::Constant(lever2);
  double unknown = 0;  // variance of the way moved along the unseen [m^2]
  for (const auto& u : unseen) {
    const Vector6 scaled = metric.asDiagonal() * u;
    unknown += scaled.dot(priorCovariance * scaled);
  }
  if (unknown <= 0) return;
  // (A^-1 + C)^-1 = A - A (C^-1 + A)^-1 A, which holds for a singular A, too; the solution of A x = b stays.
  const double leak2 = std::max(kUnseenLeak * kUnseenLeak, equations.unseenLeak2);
  const Matrix6 inverseNoise = (metric / (leak2 * unknown)).asDiagonal();
  const Matrix6 gain = (inverseNoise + equations.A).ldlt().solve(equations.A).transpose();
  equations.b -= (gain * equations.b).eval();
  equations.A -= (gain * equations.A).eval();
}

void removeShared(const std::vector<Vector6>& unseen, const std::vector<Vector6>& unseenByOther,
                  NormalEquations& equations) {
  if (unseen.empty() || unseenByOther.empty()) return;
  const double lever = std::sqrt(equations.meanLever2_m2);
  Vector6 scale;
  scale << Vector3d::Ones(), Vector3d::Constant(std::max(lever, 1e-3));
  const Eigen::MatrixXd other = basisOf(unseenByOther, scale);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(other.transpose() * basisOf(unseen, scale), Eigen::ComputeThinU);
  Matrix6 keep = Matrix6::Identity();
  for (Eigen::Index i = 0; i < svd.singularValues().size(); ++i) {
    if (svd.singularValues()[i] < kSame) continue;
    const Vector6 shared = other * svd.matrixU().col(i);
    keep -= shared * shared.transpose();
  }
  const Matrix6 byMotion = scale.cwiseInverse().asDiagonal() * keep * scale.asDiagonal();
  equations.A = (byMotion.transpose() * equations.A * byMotion).eval();
  equations.b = (byMotion.transpose() * equations.b).eval();
}

RegistrationResult registerPoints(const BodyPoints& points, const PlaneMap& map, const PoseBelief& prior,
                                  const core::Isometry& T_start, const RegistrationOptions& options,
                                  const std::vector<Vector6>& unseenByOther) {
  RegistrationResult result;
  result.pose = prior;
  const Matrix6 priorInformation = prior.covariance.ldlt().solve(Matrix6::Identity());
  core::Isometry T = T_start;
  Matrix6 total = Matrix6::Identity();
  double priorShare = 1.0;
  for (result.iterations = 1; result.iterations <= options.maxIterations; ++result.iterations) {
    NormalEquations equations = linearise(points, map, T, prior.covariance, priorShare, options);
    result.matches = equations.matches;
    result.residualScale = equations.residualScale;
    if (equations.matches < static_cast<std::size_t>(options.minMatches)) {
      result.end = RegistrationEnd::tooFewMatches;
      return result;
    }
    result.degenerateMotions = removePretended(equations, options.degeneracyRatio);
    removeShared(result.degenerateMotions, unseenByOther, equations);
    allowForUnseen(result.degenerateMotions, prior.covariance, equations);
    result.information = equations.A;
    const Vector6 e = differenceFrom(prior.T_map_body, T);
    Matrix6 J = Matrix6::Identity();
    J.bottomRightCorner<3, 3>() = core::rightJacobianSo3(e.tail<3>()).inverse();
    total = J.transpose() * priorInformation * J + equations.A;
    const Vector6 step = -total.ldlt().solve(J.transpose() * priorInformation * e + equations.b);
    moveBy(step, T);
    result.end = RegistrationEnd::iterationLimit;
    const bool isSharp = priorShare * equations.priorRatio < 1.0;
    priorShare *= kPriorFade;
    if (isSharp && step.head<3>().norm() < options.stopTranslation_m &&
        step.tail<3>().norm() < options.stopRotation_rad) {
      result.end = RegistrationEnd::converged;
      break;
    }
  }
  result.iterations = std::min(result.iterations, options.maxIterations);
  result.pose.T_map_body = T;
  result.pose.covariance = total.ldlt().solve(Matrix6::Identity());
  return result;
}

}  // namespace s2s::odometry
