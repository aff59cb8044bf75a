#pragma once

#include "s2s/odometry/registration.h"

namespace s2s::graph {

/// Adds a point's distance to a plane to the equations of a body perturbation (translation, rotation) of the source.
/// @param normal_source of the plane, in the source's frame
/// @param tiltVariance_rad2 of that normal
/// @return derivative of the residual by the perturbation
core::Vector6 addPointToPlane(const Eigen::Vector3d& p_source, const Eigen::Vector3d& normal_source, double residual_m,
                              double weight, double tiltVariance_rad2, odometry::NormalEquations& equations);

/// Gauss-Newton step in the directions that the equations determine, and no motion in the others.
core::Vector6 determinedStep(const odometry::NormalEquations& equations);

/// T (+) step.
void applyStep(const core::Vector6& step, core::Isometry& T);

/// Inverse of the determined information, very wide (10 m, 0.3 rad) where there is none, plus floors [m, rad].
core::Matrix6 covarianceFrom(core::Matrix6 information, const core::Vector6& floorSigma);

}  // namespace s2s::graph
