#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "s2s/core/transform.h"
#include "s2s/eval/statistics.h"

namespace s2s::eval {

/// A surveyed point (world frame) or a point picked in the map (map frame).
struct NamedPoint {
  std::string id;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< metres
  double sigma_m = 0;                                  ///< standard deviation of each coordinate; zero if not known
};

/// Reads `id,x,y,z` and, if present, `sigma` from a CSV file.
/// @throws core::InputError for a missing or damaged file, or an id that stands twice
std::vector<NamedPoint> readNamedPoints(const std::string& path);

struct ControlPointError {
  std::string id;
  double error_m = 0;                      ///< distance of the aligned pick from the control point
  Eigen::Vector3d residual_m = {0, 0, 0};  ///< aligned pick minus control point, world axes
  std::optional<double> leaveOneOut_m;     ///< the same when this point took no part in the alignment
};

/// The paper's evaluation above water (section Results): picks are aligned rigidly to surveyed points by singular value
/// decomposition, and the error of each is the Euclidean norm of what remains.
struct ControlReport {
  core::Isometry T_world_map = core::Isometry::Identity();
  std::vector<ControlPointError> points;
  std::vector<std::string> notPicked;  ///< control points without a pick; they take no part
  MeanInterval error_m;                ///< the paper's figure: mean of the residual norms
  double rmse_m = 0;
  std::optional<MeanInterval> leaveOneOut_m;  ///< over the points that have it; absent if fewer than two have
  double offLine_m = 0;                       ///< rms distance of the points from their best line
  double meanSigma_m = 0;                     ///< mean standard deviation of the control points used
};

/// The residual norms flatter: the alignment takes six of the 3 n degrees of freedom out of them. The leave-one-out
/// error does not, as each point is predicted by an alignment made without it. It exists for a point if the others are
/// at least three and not collinear.
/// @throws core::InputError for fewer than three pairs, collinear points, or a pick whose id is no control point
ControlReport evaluateControlPoints(const std::vector<NamedPoint>& control, const std::vector<NamedPoint>& picks);

}  // namespace s2s::eval
