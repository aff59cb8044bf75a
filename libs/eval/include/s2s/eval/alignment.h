#pragma once

#include <Eigen/Core>
#include <vector>

#include "s2s/core/transform.h"

namespace s2s::eval {

enum class AlignmentStatus {
  Ok,
  TooFewPoints,  ///< fewer than three: the rotation is not determined
  Collinear      ///< all near one line: the rotation about it is not determined
};

struct PointAlignment {
  AlignmentStatus status = AlignmentStatus::TooFewPoints;
  core::Isometry T_target_source = core::Isometry::Identity();
  double rmse_m = 0;       ///< root of the mean squared distance of the pairs after the alignment
  double offLine_m = 0;    ///< rms distance of the source points from their best line
  double alongLine_m = 0;  ///< rms extent of the source points along it
};

/// Points whose rms distance from their best line is less than this share of their rms extent along it count as
/// collinear.
constexpr double kCollinearShare = 0.01;

/// The rigid motion without scale that brings the source points onto the target points in the least-squares sense
/// (Kabsch 1976; Umeyama 1991, eq. 40-42 with c = 1). With status `Collinear` the transform still minimises the
/// distances, but the rotation about the line is arbitrary.
/// @pre both lists have the same length
PointAlignment alignPoints(const std::vector<Eigen::Vector3d>& source, const std::vector<Eigen::Vector3d>& target);

/// The rigid motion that brings source poses onto target poses, positions and attitudes together, in closed form: it
/// minimises the mean squared displacement of the body origin and of three points `lever_m` along the body's axes.
/// Determined by a single pose already, and so also for a straight path, where positions alone leave the roll open.
/// @pre both lists have the same length, at least one; `lever_m` > 0
core::Isometry alignPoses(const std::vector<core::Isometry>& source, const std::vector<core::Isometry>& target,
                          double lever_m);

}  // namespace s2s::eval
