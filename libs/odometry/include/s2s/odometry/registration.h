#pragma once

#include <Eigen/Core>
#include <vector>

#include "s2s/core/transform.h"
#include "s2s/odometry/options.h"
#include "s2s/odometry/plane_map.h"

namespace s2s::odometry {

/// Points of one moment in a body frame, with the variance of each along any direction.
struct BodyPoints {
  std::vector<Eigen::Vector3d> points_body;  ///< [m]
  std::vector<double> variance_m2;
};

/// Gaussian belief about T_map_body: errors are (translation in map, added; rotation vector in body, from the right).
struct PoseBelief {
  core::Isometry T_map_body = core::Isometry::Identity();
  core::Matrix6 covariance = core::Matrix6::Identity();
};

enum class RegistrationEnd { converged, iterationLimit, tooFewMatches };

struct RegistrationResult {
  RegistrationEnd end = RegistrationEnd::tooFewMatches;
  PoseBelief pose;                                    ///< posterior; the prior if there were too few matches
  core::Matrix6 information = core::Matrix6::Zero();  ///< of the scan alone, without degenerate directions
  int iterations = 0;
  std::size_t matches = 0;   ///< points with a plane, within the gate
  double residualScale = 0;  ///< robust scale of the residuals over their expected standard deviation; 1 is ideal
  /// Motions (translation in map [m], rotation vector in body [rad]) that the scan does not see, each scaled to move
  /// the points by about 1 m.
  std::vector<core::Vector6> degenerateMotions;
};

/// Sums of the weighted point-to-plane problem at one pose.
struct NormalEquations {
  core::Matrix6 A = core::Matrix6::Zero();  ///< sum of w h h^T
  core::Vector6 b = core::Vector6::Zero();  ///< sum of w h r
  /// Information that the noise of the planes' normals pretends: sum of w times the covariance of h.
  core::Matrix6 pretended = core::Matrix6::Zero();
  double meanLever2_m2 = 0;  ///< mean |p_body|^2
  double unseenLeak2 = 0;    ///< squared share of an unseen motion that may show in what is seen, by the normals' noise
  std::size_t matches = 0;
  double residualScale = 0;
  double priorRatio = 0;  ///< greatest variance of a residual from the prior over that of its noise
};

/// Point-to-plane residuals r = n . (T p) - d with their Jacobian h at `T`, weighted by 1 / (point + plane variance)
/// and a Cauchy kernel. Its width is the larger of the expected and the observed (median) size of the residuals, and on
/// top of that `priorShare` of the variance that the prior leaves to the residual: else the many surfaces that already
/// fit would make outliers of the few that alone show a large error in some direction.
NormalEquations linearise(const BodyPoints& points, const PlaneMap& map, const core::Isometry& T,
                          const core::Matrix6& priorCovariance, double priorShare, const RegistrationOptions& options);

/// Takes out of the equations what is not known but pretended by noisy normals, and returns the motions about which
/// nothing remains.
///
/// With h = h0 + noise of covariance C, the expectation of sum w h h^T is the true information plus sum w C. In the
/// coordinates that make the latter the unit matrix and the former diagonal (generalised eigenvectors), each value mu
/// is reduced to mu - ratio, and to zero if it would be negative; the gradient shrinks alike.
std::vector<core::Vector6> removePretended(NormalEquations& equations, double ratio);

/// Takes out of the equations the motions that another sensor does not see and these equations hardly see either: two
/// sensors blind for the same motion, each a little off in its direction, would otherwise between them pretend to know
/// what neither sees.
/// @param unseen         by these equations
/// @param unseenByOther  by the other sensor; those within some 25 degrees of `unseen` (rotations scaled by the points'
///                       mean distance) are taken out exactly
void removeShared(const std::vector<core::Vector6>& unseen, const std::vector<core::Vector6>& unseenByOther,
                  NormalEquations& equations);

/// Weakens what a scan says where much is unknown along unseen motions: their directions come from the map and are off
/// by as much as the noise of the normals leaves, so that an error along them shows in the others, again and again the
/// same way. Without this the filter would believe, scan by scan, to know what nothing in sight tells.
void allowForUnseen(const std::vector<core::Vector6>& unseen, const core::Matrix6& priorCovariance,
                    NormalEquations& equations);

/// Most probable pose given a prior and the scan's points on the map's planes (iterated, with the points matched anew
/// in each iteration), and its covariance: the update of an iterated Kalman filter in its pose block.
/// @param unseenByOther  motions that a sensor whose update is in the prior did not see (`removeShared`)
RegistrationResult registerPoints(const BodyPoints& points, const PlaneMap& map, const PoseBelief& prior,
                                  const core::Isometry& T_start, const RegistrationOptions& options,
                                  const std::vector<core::Vector6>& unseenByOther = {});

}  // namespace s2s::odometry
