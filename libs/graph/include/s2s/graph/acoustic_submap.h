#pragma once

#include <Eigen/Core>
#include <vector>

#include "s2s/core/time.h"
#include "s2s/core/transform.h"

namespace s2s::graph {

/// Displacements [m] by one standard deviation of each of two errors that all points of a swath share. Where the
/// aperture of a sonar ends (which elevation gives the first echo) is known no better than about a degree; and the
/// first echo of a beam across which the range grows comes from its nearer side, not from its middle.
using SharedErrors = Eigen::Matrix<float, 3, 2>;

/// A point that sonars saw, with the standard deviation of its distance to the surface.
struct AcousticPoint {
  Eigen::Vector3f p = Eigen::Vector3f::Zero();  ///< metres, in the frame that the variable's name says
  float sigma_m = 0;
  SharedErrors shared_m = SharedErrors::Zero();  ///< zero for stereo points
};
using AcousticCloud = std::vector<AcousticPoint>;

/// What the sonars saw along a few metres of path, put together by the odometry.
struct AcousticSubmap {
  core::TimeNs time = 0;                                       ///< of the pose below, about the middle of the path
  core::Isometry T_odom_vehicle = core::Isometry::Identity();  ///< at that time; the frame of the points
  AcousticCloud stereo_vehicle;                                ///< the odometry registers these points, too
  AcousticCloud swath_vehicle;                                 ///< line-scan points, which nobody has registered yet
};

/// The mean of the points in each cube, weighted by their variances, in an order that depends on nothing but the
/// points. No mean is believed better than `leastSigma_m`, which errors that points share would not average out of.
/// Points that are not finite or have no positive sigma are dropped.
AcousticCloud thinned(const AcousticCloud& points, double voxel_m, double leastSigma_m);

void appendTransformed(const core::Isometry& T, const AcousticCloud& points, AcousticCloud& to);

}  // namespace s2s::graph
