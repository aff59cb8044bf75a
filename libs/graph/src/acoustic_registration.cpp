#include "s2s/graph/acoustic_registration.h"

#include <algorithm>
#include <cmath>

#include "point_to_plane.h"

namespace s2s::graph {

namespace {

/// Squared residual in standard deviations that a point without partner is taken to have.
constexpr double kMissed2 = 9;
/// Steps of this many standard deviations of the initial value are worth a start of their own.
constexpr double kStartReach_sigma = 2;
constexpr int kMostRings = 2;
/// Squared Mahalanobis distance beyond which two fits are not the same: the 99.9 % quantile.
constexpr double kElsewhereChi2 = 22.5;

RegistrationOptions targetOptions(const AcousticRegistrationOptions& options) {
  RegistrationOptions target;
  target.voxel_m = 0;  // thinned already
  target.normalNeighbours = options.normalNeighbours;
  return target;
}

Cloud positions(const AcousticCloud& points) {
  Cloud cloud;
  cloud.reserve(points.size());
  for (const auto& point : points) cloud.push_back(point.p);
  return cloud;
}

/// A pose, and the errors that all swath points share in standard deviations.
struct State {
  core::Isometry T = core::Isometry::Identity();
  Eigen::Vector2d shared = Eigen::Vector2d::Zero();
};

struct Partners {
  odometry::NormalEquations equations;
  Eigen::Matrix<double, 6, 2> cross = Eigen::Matrix<double, 6, 2>::Zero();  ///< sum of w h g^T, g by the shared errors
  Eigen::Matrix2d sharedInformation = Eigen::Matrix2d::Zero();              ///< sum of w g g^T
  Eigen::Vector2d sharedSlope = Eigen::Vector2d::Zero();                    ///< sum of w g r
  double squares_m2 = 0;
  double chi2 = 0;  ///< sum over partners
  double cost = 0;  ///< sum over all points, each bounded
};

/// @param widening of all standard deviations, while partners are still sought from afar
Partners findPartners(const AcousticTarget& target, const AcousticCloud& source, const State& state, double distance_m,
                      double widening, const AcousticRegistrationOptions& options) {
  Partners partners;
  RegistrationTarget::Plane plane;
  for (const auto& point : source) {
    const Eigen::Matrix<double, 3, 2> shared_m = point.shared_m.cast<double>();
    const Eigen::Vector3d p = point.p.cast<double>() - shared_m * state.shared;
    if (!target.planes().nearestPlane(state.T * p, distance_m, plane)) {
      partners.cost += kMissed2;
      continue;
    }
    const Eigen::Vector3d normal_source = state.T.linear().transpose() * plane.normal;
    const Eigen::Vector2d ofTarget_m = target.point(plane.index).shared_m.cast<double>().transpose() * plane.normal;
    const double residual_m = plane.normal.dot(state.T * p - plane.point) + state.shared.dot(ofTarget_m);
    const Eigen::Vector2d byShared_m = ofTarget_m - shared_m.transpose() * normal_source;
    const double variance_m2 =
        plane.variance_m2 + std::max(std::pow(options.leastSigma_m, 2), std::pow<double>(point.sigma_m, 2));
    const double ratio2 = residual_m * residual_m / variance_m2;
    const double inLoss = 1 + ratio2 / std::pow(options.lossWidth * widening, 2);
    const double weight = 1 / (variance_m2 * inLoss * inLoss);
    const core::Vector6 h =
        addPointToPlane(p, normal_source, residual_m, weight, plane.tiltVariance_rad2, partners.equations);
    partners.cross += weight * h * byShared_m.transpose();
    partners.sharedInformation += weight * byShared_m * byShared_m.transpose();
    partners.sharedSlope += weight * residual_m * byShared_m;
    partners.squares_m2 += residual_m * residual_m;
    partners.chi2 += ratio2;
    partners.cost += std::min(ratio2, kMissed2);
  }
  partners.equations.meanLever2_m2 /= static_cast<double>(std::max<std::size_t>(partners.equations.matches, 1));
  return partners;
}

/// Takes the shared errors out of the equations (Schur complement), their prior being worth `together` points.
void marginalise(const State& state, double together, Partners& partners) {
  partners.sharedInformation.diagonal().array() += together;
  partners.sharedSlope += together * state.shared;
  const Eigen::Matrix2d inverse = partners.sharedInformation.inverse();
  partners.equations.A -= partners.cross * inverse * partners.cross.transpose();
  partners.equations.b -= partners.cross * inverse * partners.sharedSlope;
}

State converge(const AcousticTarget& target, const AcousticCloud& source, State state,
               const AcousticRegistrationOptions& options) {
  double distance_m = options.coarsePartner_m;
  for (int iteration = 0; iteration < options.maxIterations; ++iteration) {
    const bool fine = distance_m <= options.finePartner_m;
    Partners partners = findPartners(target, source, state, distance_m, distance_m / options.finePartner_m, options);
    marginalise(state, options.correlatedPoints, partners);
    odometry::removePretended(partners.equations, options.degeneracyRatio);
    const core::Vector6 step = determinedStep(partners.equations);
    applyStep(step, state.T);
    state.shared -= partners.sharedInformation.inverse() * (partners.sharedSlope + partners.cross.transpose() * step);
    if (fine && step.head<3>().norm() < 5e-4 && step.tail<3>().norm() < 1e-4) break;
    if (!fine) distance_m = std::max(0.7 * distance_m, options.finePartner_m);
  }
  return state;
}

/// Horizontal offsets from the initial value within reach of what it leaves open; the first is none.
std::vector<Eigen::Vector3d> starts(double priorSigma_m, double spacing_m) {
  const int rings = std::min(kMostRings, static_cast<int>(std::lround(kStartReach_sigma * priorSigma_m / spacing_m)));
  std::vector<Eigen::Vector3d> offsets{Eigen::Vector3d::Zero()};
  for (int x = -rings; x <= rings; ++x)
    for (int y = -rings; y <= rings; ++y)
      if (x != 0 || y != 0) offsets.emplace_back(x * spacing_m, y * spacing_m, 0);
  return offsets;
}

struct Fit {
  State state;
  double cost = 0;
};

/// Fits from all starts, the best one first.
std::vector<Fit> fitsFromAllStarts(const AcousticTarget& target, const AcousticCloud& source,
                                   const core::Isometry& T_initial, double priorSigma_m,
                                   const AcousticRegistrationOptions& options) {
  std::vector<Fit> fits;
  for (const Eigen::Vector3d& offset : starts(priorSigma_m, options.startSpacing_m)) {
    State start{T_initial, Eigen::Vector2d::Zero()};
    start.T.pretranslate(offset);
    Fit fit{converge(target, source, start, options), 0};
    fit.cost = findPartners(target, source, fit.state, options.finePartner_m, 1, options).cost;
    fits.push_back(fit);
  }
  std::stable_sort(fits.begin(), fits.end(), [](const Fit& a, const Fit& b) { return a.cost < b.cost; });
  return fits;
}

/// True if a fit nearly as good as the best lies elsewhere, in directions that the seabed tells.
bool isAmbiguous(const std::vector<Fit>& fits, const core::Matrix6& information,
                 const AcousticRegistrationOptions& options) {
  return std::any_of(fits.begin() + 1, fits.end(), [&](const Fit& fit) {
    const core::Isometry E = fits.front().state.T.inverse() * fit.state.T;
    core::Vector6 e;
    e << E.translation(), core::logSo3(E.linear());
    return e.dot(information * e) > kElsewhereChi2 && fit.cost < options.ambiguousRatio * fits.front().cost;
  });
}

AcousticFit judge(const AcousticRegistrationResult& result, const AcousticRegistrationOptions& options) {
  if (result.overlap < options.minOverlap) return AcousticFit::tooFewPartners;
  if (result.chi2 > options.maxChi2) return AcousticFit::residualTooLarge;
  if (result.degenerate > options.maxDegenerate) return AcousticFit::degenerate;
  return AcousticFit::good;
}

}  // namespace

AcousticTarget::AcousticTarget(const AcousticCloud& points, const AcousticRegistrationOptions& options)
    : points_(thinned(points, options.voxel_m, options.leastSigma_m)),
      planes_(positions(points_), targetOptions(options)) {}

AcousticRegistrationResult registerAcoustic(const AcousticTarget& target, const AcousticCloud& source,
                                            const core::Isometry& T_target_source_initial, double priorSigma_m,
                                            const AcousticRegistrationOptions& options) {
  AcousticRegistrationResult result;
  result.T_target_source = T_target_source_initial;
  if (target.planes().size() == 0 || source.size() < static_cast<std::size_t>(options.minPoints)) return result;
  const auto fits = fitsFromAllStarts(target, source, T_target_source_initial, priorSigma_m, options);
  const State& best = fits.front().state;
  result.T_target_source = best.T;
  Partners partners = findPartners(target, source, best, options.finePartner_m, 1, options);
  const auto count = static_cast<double>(std::max<std::size_t>(partners.equations.matches, 1));
  result.overlap = static_cast<double>(partners.equations.matches) / static_cast<double>(source.size());
  result.sharedErrors = best.shared;
  result.rmse_m = std::sqrt(partners.squares_m2 / count);
  result.chi2 = partners.chi2 / count;
  const double together = options.correlatedPoints * std::max(1.0, result.chi2);
  marginalise(best, together, partners);
  result.degenerate = static_cast<int>(odometry::removePretended(partners.equations, options.degeneracyRatio).size());
  core::Vector6 floorSigma;
  floorSigma << options.floorHorizontal_m, options.floorHorizontal_m, options.floorHeight_m, options.floorTilt_rad,
      options.floorTilt_rad, options.floorYaw_rad;
  const core::Matrix6 information = partners.equations.A / together;
  result.covariance = covarianceFrom(information, floorSigma);
  result.fit = judge(result, options);
  if (result.fit == AcousticFit::good && isAmbiguous(fits, information, options)) result.fit = AcousticFit::ambiguous;
  return result;
}

}  // namespace s2s::graph
