#pragma once

#include <memory>

#include "s2s/graph/cloud.h"

namespace s2s::graph {

struct RegistrationOptions {
  double voxel_m = 0.25;         ///< thinning of the target submap; 0: none
  int normalNeighbours = 12;     ///< points that define a target point's plane
  double coarsePartner_m = 3.0;  ///< largest distance of partners in the first iterations
  double finePartner_m = 0.5;    ///< and in the last
  int maxIterations = 40;
  double residualScale_m = 0.1;  ///< width of the robust weight (Geman-McClure) in the last iterations
  double minOverlap = 0.5;       ///< share of source points with a partner
  double maxRmse_m = 0.15;       ///< of the point-to-plane distances of partners
  /// This many times what the noise of the normals pretends to know is taken off the information; see
  /// odometry::removePretended.
  double degeneracyRatio = 3;
  /// More directions (of six) without information than this, and the clouds tell too little: a straight canal hides
  /// the way along it, the height and the pitch.
  int maxDegenerate = 3;
  double correlatedPoints = 20;      ///< points that count as one independent measurement, for the covariance
  double floorTranslation_m = 0.01;  ///< added to the covariance: what point counts cannot know
  double floorRotation_rad = 0.0005;
};

enum class RegistrationStatus { converged, tooFewPartners, residualTooLarge, degenerate };

struct RegistrationResult {
  RegistrationStatus status = RegistrationStatus::tooFewPartners;
  core::Isometry T_target_source = core::Isometry::Identity();
  core::Matrix6 covariance = core::Matrix6::Zero();  ///< body perturbation of T_target_source
  double overlap = 0, rmse_m = 0;
  int degenerate = 0;  ///< directions without information; the covariance is very large there
  int iterations = 0;
};

/// A cloud prepared as target: thinned, with planes, searchable.
class RegistrationTarget {
 public:
  RegistrationTarget(const Cloud& points, const RegistrationOptions& options);
  ~RegistrationTarget();
  RegistrationTarget(const RegistrationTarget&) = delete;
  RegistrationTarget& operator=(const RegistrationTarget&) = delete;

  std::size_t size() const { return points_.size(); }
  struct Plane {
    Eigen::Vector3d point, normal;
    double tiltVariance_rad2 = 0;  ///< of the normal
    double variance_m2 = 0;        ///< of the target's points across the plane
    std::size_t index = 0;         ///< of the nearest point, in the thinned target
  };
  /// The plane of the nearest point within `distance_m` that has one.
  bool nearestPlane(const Eigen::Vector3d& query, double distance_m, Plane& plane) const;

 private:
  struct Index;
  Cloud points_;
  std::vector<Eigen::Vector3f> normals_;  ///< zero length where the surroundings are no plane
  std::vector<float> tiltVariances_rad2_, variances_m2_;
  std::unique_ptr<Index> index_;
};

/// Point-to-plane ICP with robust weights, from coarse to fine partner distances. The odometry's own registration
/// matches within voxels of planes, which is faster but must start within a voxel of the solution; a loop closure
/// starts metres off, so this one looks for the nearest point. Directions that the clouds do not determine keep their
/// initial value.
RegistrationResult registerCloud(const RegistrationTarget& target, const Cloud& source,
                                 const core::Isometry& T_target_source_initial, const RegistrationOptions& options);

}  // namespace s2s::graph
