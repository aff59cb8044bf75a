#pragma once

#include "s2s/graph/acoustic_submap.h"
#include "s2s/graph/cloud_registration.h"
#include "s2s/graph/sonar_factors.h"

namespace s2s::graph {

enum class AcousticFit {
  good,
  tooFewPoints,
  tooFewPartners,
  residualTooLarge,  ///< against the standard deviations that points and planes claim
  degenerate,
  ambiguous  ///< it fits in another place nearly as well
};

struct AcousticRegistrationResult {
  AcousticFit fit = AcousticFit::tooFewPoints;
  core::Isometry T_target_source = core::Isometry::Identity();
  core::Matrix6 covariance = core::Matrix6::Zero();  ///< body perturbation of T_target_source
  double overlap = 0;                                ///< share of the points with a partner
  double rmse_m = 0;                                 ///< of the point-to-plane distances of partners
  double chi2 = 0;                                   ///< mean square of these over their variances; 1 is ideal
  int degenerate = 0;  ///< directions without information: the covariance is very wide there
  Eigen::Vector2d sharedErrors = Eigen::Vector2d::Zero();  ///< of the swath's points, in standard deviations
};

/// An acoustic submap prepared as target: thinned, with planes, searchable.
class AcousticTarget {
 public:
  AcousticTarget(const AcousticCloud& points, const AcousticRegistrationOptions& options);
  const RegistrationTarget& planes() const { return planes_; }
  /// The point that a plane of `planes()` stands for.
  const AcousticPoint& point(std::size_t index) const { return points_[index]; }

 private:
  AcousticCloud points_;
  RegistrationTarget planes_;
};

/// Registers what the sonars saw to what they saw before: point to plane, each residual weighted by the variances of
/// point and plane, with a robust kernel.
///
/// A flat seabed tells height, roll and pitch; ripples, stones and slopes the rest, as far as they stand out of the
/// noise of the planes' normals. Directions that are not told keep their initial value and get no information. The
/// covariance is that of the weighted problem with `correlatedPoints` counted as one, widened if the residuals are
/// larger than claimed, plus the floor. The errors that all swath points share (AcousticPoint::shared_m) are
/// estimated along, with one standard deviation as their prior, so that what they could explain is not taken for
/// knowledge.
///
/// @param source only points where the target has some; thinned with `voxel_m`
/// @param priorSigma_m horizontal standard deviation of the initial value: where it leaves room, several starts are
///        tried, and a seabed that fits in two places is refused
AcousticRegistrationResult registerAcoustic(const AcousticTarget& target, const AcousticCloud& source,
                                            const core::Isometry& T_target_source_initial, double priorSigma_m,
                                            const AcousticRegistrationOptions& options);

}  // namespace s2s::graph
