#include "s2s/sonar/triangulation.h"

#include <Eigen/Dense>
#include <cmath>

#include "s2s/sonar/ping_geometry.h"

namespace s2s::sonar {

namespace {

using Row = Eigen::RowVector3d;
using Residuals = Eigen::Vector4d;
using Jacobian = Eigen::Matrix<double, 4, 3>;

double wrapAngle(double angle_rad) { return std::remainder(angle_rad, 2 * M_PI); }

/// d bearing / d p_sonar.
Row bearingGradient(const Eigen::Vector3d& p, obs::BearingModel model) {
  if (model == obs::BearingModel::Azimuth) {
    const double squared = p.x() * p.x() + p.y() * p.y();
    return {-p.y() / squared, p.x() / squared, 0};
  }
  const double range = p.norm(), across = std::hypot(p.x(), p.z());
  const double u = p.y() / (range * range * across);
  return {-u * p.x(), across / (range * range), -u * p.z()};
}

/// Range and bearing residuals of one sonar, weighted, with their Jacobian by p_sonar.
void weigh(const Eigen::Vector3d& p_sonar, const BeamMeasurement& m, obs::BearingModel model,
           Eigen::Ref<Eigen::Vector2d> residuals, Eigen::Ref<Eigen::Matrix<double, 2, 3>> jacobian) {
  const SonarCoordinates at = sonarCoordinates(p_sonar, model);
  residuals << (at.range_m - m.range_m) / m.rangeSigma_m,
      wrapAngle(at.bearing_rad - m.bearing_rad) / m.bearingSigma_rad;
  jacobian.row(0) = p_sonar.transpose() / (at.range_m * m.rangeSigma_m);
  jacobian.row(1) = bearingGradient(p_sonar, model) / m.bearingSigma_rad;
}

void weighBoth(const Eigen::Vector3d& p_h, const core::Isometry& T_v_h, const BeamMeasurement& h,
               const BeamMeasurement& v, obs::BearingModel model_h, obs::BearingModel model_v, Residuals& residuals,
               Jacobian& jacobian) {
  Eigen::Matrix<double, 2, 3> block;
  weigh(p_h, h, model_h, residuals.head<2>(), block);
  jacobian.topRows<2>() = block;
  weigh(T_v_h * p_h, v, model_v, residuals.tail<2>(), block);
  jacobian.bottomRows<2>() = block * T_v_h.linear();
}

Eigen::Vector3d inPlane(const BeamMeasurement& m, obs::BearingModel model) {
  return pointAt({m.range_m, m.bearing_rad, 0}, model);
}

/// Covariance of a point placed on a sonar's imaging plane, in the sonar's frame.
Eigen::Matrix3d inPlaneCovariance(const BeamMeasurement& m) {
  const Eigen::Vector3d along(std::cos(m.bearing_rad), std::sin(m.bearing_rad), 0);
  const Eigen::Vector3d across(-along.y(), along.x(), 0);
  const double acrossSigma_m = m.range_m * m.bearingSigma_rad;
  return m.rangeSigma_m * m.rangeSigma_m * along * along.transpose() +
         acrossSigma_m * acrossSigma_m * across * across.transpose();
}

/// Variance across the imaging plane of a point anywhere in the aperture.
double elevationVariance(const BeamMeasurement& m, double aperture_rad) {
  const double height_m = 2 * m.range_m * std::sin(0.5 * aperture_rad);
  return height_m * height_m / 12.0;
}

/// The projector that keeps the coordinates of a sonar's imaging plane, in the horizontal sonar's frame.
Eigen::Matrix3d planeProjector(const Eigen::Matrix3d& R_h_sonar) {
  return Eigen::Matrix3d::Identity() - R_h_sonar.col(2) * R_h_sonar.col(2).transpose();
}

}  // namespace

Triangulator::Triangulator(const core::Isometry& T_h_v, obs::BearingModel model_h, obs::BearingModel model_v,
                           double aperture_h_rad, double aperture_v_rad, const TriangulationOptions& options)
    : T_h_v_(T_h_v),
      T_v_h_(T_h_v.inverse()),
      model_h_(model_h),
      model_v_(model_v),
      aperture_h_rad_(aperture_h_rad),
      aperture_v_rad_(aperture_v_rad),
      options_(options) {}

Eigen::Vector3d Triangulator::fuseByCoordinate(const BeamMeasurement& h, const BeamMeasurement& v) const {
  // Each sonar knows the two coordinates of its plane: (P_h + P_v) p = P_h p_h + P_v p_v.
  const Eigen::Matrix3d P_h = planeProjector(Eigen::Matrix3d::Identity()), P_v = planeProjector(T_h_v_.linear());
  const Eigen::Vector3d b = P_h * inPlane(h, model_h_) + P_v * (T_h_v_ * inPlane(v, model_v_));
  return (P_h + P_v).ldlt().solve(b);
}

/// A point from which both bearings have a gradient: in front of both sonars, off their origins.
Eigen::Vector3d Triangulator::startNear(const Eigen::Vector3d& guess) const {
  return guess.allFinite() && guess.norm() > 1e-3 ? guess : Eigen::Vector3d(1, 0, 0);
}

Triangulation Triangulator::fuseExactly(const BeamMeasurement& h, const BeamMeasurement& v) const {
  Triangulation result;
  Residuals e;
  Jacobian J;
  Eigen::Vector3d p = startNear(fuseByCoordinate(h, v));
  for (int i = 0; i < options_.maxIterations; ++i) {
    weighBoth(p, T_v_h_, h, v, model_h_, model_v_, e, J);
    const Eigen::LDLT<Eigen::Matrix3d> normal(J.transpose() * J);
    // Parallel imaging planes leave the elevation free; a pivot far below the largest one tells.
    const Eigen::Vector3d pivots = normal.vectorD();
    if (!pivots.allFinite() || pivots.minCoeff() < 1e-9 * pivots.maxCoeff()) return result;
    const Eigen::Vector3d step = -normal.solve(J.transpose() * e);
    p += step;
    if (!p.allFinite()) return result;
    if (step.norm() > 1e-7) continue;
    result.converged = true;
    break;
  }
  weighBoth(p, T_v_h_, h, v, model_h_, model_v_, e, J);
  result.p_h = p;
  result.covariance = (J.transpose() * J).inverse();
  result.residual = e.norm();
  return result;
}

Triangulation Triangulator::describe(const Eigen::Vector3d& p_h, const BeamMeasurement& h,
                                     const BeamMeasurement& v) const {
  Triangulation result;
  result.p_h = p_h;
  result.converged = p_h.allFinite();
  const Eigen::Matrix3d R = T_h_v_.linear();
  Eigen::Matrix3d C_h = inPlaneCovariance(h), C_v = R * inPlaneCovariance(v) * R.transpose();
  if (options_.fusion == Fusion::Average) {
    C_h += elevationVariance(h, aperture_h_rad_) * Eigen::Vector3d::UnitZ() * Eigen::RowVector3d::UnitZ();
    C_v += elevationVariance(v, aperture_v_rad_) * R.col(2) * R.col(2).transpose();
    result.covariance = 0.25 * (C_h + C_v);
  } else {
    const Eigen::Matrix3d P_h = planeProjector(Eigen::Matrix3d::Identity()), P_v = planeProjector(R);
    const Eigen::Matrix3d K = (P_h + P_v).inverse();
    result.covariance = K * (P_h * C_h * P_h + P_v * C_v * P_v) * K.transpose();
  }
  Residuals e;
  Jacobian J;
  weighBoth(p_h, T_v_h_, h, v, model_h_, model_v_, e, J);
  result.residual = e.norm();
  return result;
}

Triangulation Triangulator::fuse(const BeamMeasurement& h, const BeamMeasurement& v) const {
  Triangulation result;
  switch (options_.fusion) {
    case Fusion::Exact:
      result = fuseExactly(h, v);
      break;
    case Fusion::Coordinate:
      result = describe(fuseByCoordinate(h, v), h, v);
      break;
    case Fusion::Average:
      result = describe(0.5 * (inPlane(h, model_h_) + T_h_v_ * inPlane(v, model_v_)), h, v);
      break;
  }
  if (!result.converged) return result;
  result.elevation_h_rad = sonarCoordinates(result.p_h, model_h_).elevation_rad;
  result.elevation_v_rad = sonarCoordinates(T_v_h_ * result.p_h, model_v_).elevation_rad;
  return result;
}

}  // namespace s2s::sonar
