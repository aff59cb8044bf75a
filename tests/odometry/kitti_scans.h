#pragma once

#include <string>
#include <vector>

#include "s2s/core/transform.h"
#include "s2s/odometry/scan.h"

/// The 22 real scans of a Velodyne HDL-64E in the shared test data.
namespace s2s::odometry::kitti {

/// Points of a binary PCD whose fields begin with x y z as floats, each point `stride` floats long.
std::vector<Eigen::Vector3f> readBinaryPcd(const std::string& path);

/// T_first_i of each scan, 12 numbers a line.
std::vector<core::Isometry> readPoses(const std::string& path);

}  // namespace s2s::odometry::kitti
