#pragma once

#include <cstddef>
#include <vector>

#include "s2s/core/trajectory.h"
#include "s2s/eval/statistics.h"

namespace s2s::eval {

/// An estimated pose and the reference pose of the same instant.
struct PosePair {
  core::TimeNs time = 0;
  core::Isometry T_ref_body = core::Isometry::Identity();
  core::Isometry T_est_body = core::Isometry::Identity();
};

/// Pairs each estimated pose with the reference interpolated to its time (geodesic, core::Trajectory::at). evo takes
/// the nearest reference stamp instead, which at 100 Hz and 1.5 m/s adds up to 7 mm that are no error of the estimate.
/// Estimated poses outside the reference, or in a gap of it longer than `maxGap_s`, have no pair.
std::vector<PosePair> pairByTime(const core::Trajectory& reference, const core::Trajectory& estimate,
                                 double maxGap_s = 0.1);

/// Absolute pose error (evo's APE, "ATE" for its translation part) after an SE(3) alignment without scale.
struct AbsoluteError {
  core::Isometry T_ref_est = core::Isometry::Identity();  ///< the alignment, est -> ref
  Summary translation_m;                                  ///< |p_ref - T_ref_est p_est|
  Summary rotation_rad;                                   ///< angle of R_ref^T R_ref_est R_est
};

/// How the estimate's frame is brought onto the reference's.
enum class TrajectoryAlignment {
  Positions,  ///< Umeyama on the positions, as evo's `--align`
  Poses       ///< positions and attitudes together, see alignPoses
};

/// Lever of `TrajectoryAlignment::Poses`: the reach of the sonars, so that points of the map count like the vessel.
constexpr double kPoseAlignmentLever_m = 10;

/// @pre `pairs` is not empty
AbsoluteError absoluteError(const std::vector<PosePair>& pairs, TrajectoryAlignment alignment);

/// Relative pose error E = (Q_i^-1 Q_j)^-1 (P_i^-1 P_j) of reference Q and estimate P (Sturm et al. 2012), over
/// consecutive pairs as in evo's default. It needs no alignment.
struct RelativeError {
  Summary translation_m;
  Summary rotation_rad;
};

/// Over pairs (0, n), (n, 2n), … for `frames` = n.
/// @pre `frames` >= 1
RelativeError relativeErrorOverFrames(const std::vector<PosePair>& pairs, std::size_t frames);

/// Over consecutive stretches of the estimated path of at least `distance_m` each; like evo, the first stretch only
/// marks where the counting begins.
/// @pre `distance_m` > 0
RelativeError relativeErrorOverDistance(const std::vector<PosePair>& pairs, double distance_m);

/// Segment errors as the KITTI odometry benchmark defines them (Geiger et al. 2012, devkit `evaluate_odometry.cpp`):
/// of all stretches of `length_m` along the reference path, the relative pose error divided by the length.
struct SegmentError {
  double length_m = 0;
  std::size_t count = 0;         ///< stretches; zero if the path is too short, and then the errors are zero too
  double translation_share = 0;  ///< mean of |t| / length; times 100 for per cent
  double rotation_radpm = 0;     ///< mean of angle / length
};

/// @param step_m distance between the starts of stretches; the devkit takes every tenth frame, i.e. about 10 m by car
SegmentError segmentError(const std::vector<PosePair>& pairs, double length_m, double step_m = 1);

}  // namespace s2s::eval
