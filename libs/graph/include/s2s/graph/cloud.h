#pragma once

#include <Eigen/Core>
#include <vector>

#include "s2s/core/transform.h"

namespace s2s::graph {

/// Points in metres, in the frame that the variable's name says.
using Cloud = std::vector<Eigen::Vector3f>;

/// The mean of the points in each cube of edge `voxel_m`, in an order that depends on nothing but the points. Points
/// that are not finite are dropped.
Cloud voxelDownsample(const Cloud& points, double voxel_m);

/// The same with the cubes enlarged until at most `maxPoints` remain.
Cloud voxelDownsampleTo(const Cloud& points, double voxel_m, std::size_t maxPoints);

/// Appends `points` moved by T.
void appendTransformed(const core::Isometry& T, const Cloud& points, Cloud& to);

}  // namespace s2s::graph
