#include "s2s/odometry/registration.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>

namespace s2s::odometry {

namespace {

using core::Matrix6;
using core::Vector6;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Width of the Cauchy kernel in robust standard deviations; 2.385 keeps 95 % efficiency on Gaussian residuals.
constexpr double kCauchyWidth = 2.385;
/// Median of |x| of a unit Gaussian.
constexpr double kMedianOfAbs = 0.6745;

struct Residual {
  Vector6 h;
  double r = 0;        // [m]
  double sigma_m = 0;  // expected
  double lever2 = 0;   // squared distance of the point from the body's origin
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
    const double gate2 = variance + residual.h.dot(priorCovariance * residual.h);
    if (residual.r * residual.r > options.gateSigma * options.gateSigma * gate2) continue;
    residual.sigma_m = std::sqrt(variance);
    residual.lever2 = p.squaredNorm();
    residuals.push_back(residual);
  }
  return residuals;
}

/// Robust scale of the residuals over their expected standard deviations.
double robustScale(const std::vector<Residual>& residuals) {
  if (residuals.empty()) return 0;
  std::vector<double> sizes;
  sizes.reserve(residuals.size());
  for (const auto& residual : residuals) sizes.push_back(std::abs(residual.r) / residual.sigma_m);
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return *middle / kMedianOfAbs;
}

/// What is left of the information about three directions when the other three are free.
Matrix3d marginal(const Matrix6& A, int at) {
  const int other = 3 - at;
  const Matrix3d rest = A.block<3, 3>(other, other) + 1e-9 * A.diagonal().maxCoeff() * Matrix3d::Identity();
  return A.block<3, 3>(at, at) - A.block<3, 3>(at, other) * rest.ldlt().solve(A.block<3, 3>(other, at));
}

std::vector<Vector3d> weakDirections(const Matrix3d& information, double limit) {
  Eigen::SelfAdjointEigenSolver<Matrix3d> solver(information);
  std::vector<Vector3d> weak;
  for (int i = 0; i < 3; ++i)
    if (solver.eigenvalues()[i] < limit) weak.emplace_back(solver.eigenvectors().col(i));
  return weak;
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
                          const Matrix6& priorCovariance, const RegistrationOptions& options) {
  const auto residuals = residualsAt(points, map, T, priorCovariance, options);
  NormalEquations sum;
  sum.matches = residuals.size();
  sum.residualScale = robustScale(residuals);
  const double scale = std::max(1.0, sum.residualScale);
  for (const auto& residual : residuals) {
    const double sigma = scale * residual.sigma_m;
    const double u = residual.r / (kCauchyWidth * sigma);
    const double w = 1.0 / ((1.0 + u * u) * sigma * sigma * options.correlation);
    const Vector6 wh = w * residual.h;
    sum.A.noalias() += wh * residual.h.transpose();
    sum.b += residual.r * wh;
    sum.weight += w;
    sum.leverWeight += w * residual.lever2;
  }
  return sum;
}

void removeDegenerate(NormalEquations& equations, double ratio, RegistrationResult& result) {
  result.degenerateTranslations_map = weakDirections(marginal(equations.A, 0), ratio * equations.weight);
  result.degenerateRotations_body = weakDirections(marginal(equations.A, 3), ratio * equations.leverWeight);
  Matrix6 keep = Matrix6::Identity();
  for (const auto& u : result.degenerateTranslations_map) keep.topLeftCorner<3, 3>() -= u * u.transpose();
  for (const auto& u : result.degenerateRotations_body) keep.bottomRightCorner<3, 3>() -= u * u.transpose();
  equations.A = (keep * equations.A * keep).eval();
  equations.b = (keep * equations.b).eval();
}

RegistrationResult registerPoints(const BodyPoints& points, const PlaneMap& map, const PoseBelief& prior,
                                  const core::Isometry& T_start, const RegistrationOptions& options) {
  RegistrationResult result;
  result.pose = prior;
  const Matrix6 priorInformation = prior.covariance.ldlt().solve(Matrix6::Identity());
  core::Isometry T = T_start;
  Matrix6 total = Matrix6::Identity();
  for (result.iterations = 1; result.iterations <= options.maxIterations; ++result.iterations) {
    NormalEquations equations = linearise(points, map, T, prior.covariance, options);
    result.matches = equations.matches;
    result.residualScale = equations.residualScale;
    if (equations.matches < static_cast<std::size_t>(options.minMatches)) {
      result.end = RegistrationEnd::tooFewMatches;
      return result;
    }
    removeDegenerate(equations, options.degeneracyRatio, result);
    result.information = equations.A;
    const Vector6 e = differenceFrom(prior.T_map_body, T);
    Matrix6 J = Matrix6::Identity();
    J.bottomRightCorner<3, 3>() = core::rightJacobianSo3(e.tail<3>()).inverse();
    total = J.transpose() * priorInformation * J + equations.A;
    const Vector6 step = -total.ldlt().solve(J.transpose() * priorInformation * e + equations.b);
    moveBy(step, T);
    result.end = RegistrationEnd::iterationLimit;
    if (step.head<3>().norm() < options.stopTranslation_m && step.tail<3>().norm() < options.stopRotation_rad) {
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
