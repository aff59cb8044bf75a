#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace s2s::odometry {

/// Indices of the first point in each cube of edge `cube_m`, in the points' order.
std::vector<std::uint32_t> onePerCube(const std::vector<Eigen::Vector3f>& points, double cube_m);

}  // namespace s2s::odometry
