#pragma once

#include <Eigen/Core>
#include <vector>

#include "s2s/core/transform.h"

namespace s2s::eval {

/// What the paper's comparison of a wall above and below the water (section Results) leaves to the user.
struct WallOptions {
  Eigen::Vector2d from_m = {0, 0};  ///< one end of the wall
  Eigen::Vector2d to_m = {0, 0};    ///< the other end
  double halfWidth_m = 1;           ///< points further than this from the wall's line are not of the wall
  double waterHeight_m = 0;         ///< LiDAR points below are disregarded
  double sonarMinHeight_m = -1e9;   ///< lower limit for sonar points, to leave out a seabed in front of the wall
  double trimShare = 0.05;          ///< share of the lowest, and of the highest, y values removed from each cloud
  int bins = 100;                   ///< places at which the densities are compared
  bool refine = true;               ///< turn and shift the line onto the LiDAR points before measuring
  bool cosineIn3d = false;          ///< cosine similarity of (x, y, z) instead of (x, y)
};

struct WallCloud {
  std::size_t points = 0;  ///< after selection and trimming
  double width_m = 0;      ///< extent in y after trimming
  double meanY_m = 0;
  double stdY_m = 0;
  double bandwidth_m = 0;       ///< of the kernel density estimate
  std::vector<double> density;  ///< over `WallReport::y_m`, integrates to one, 1/m
};

struct WallReport {
  double length_m = 0;
  core::Isometry T_wall_map = core::Isometry::Identity();  ///< x along the wall, y across, z up; origin at its middle
  double turn_rad = 0;                                     ///< turn of the line by the refinement
  double shift_m = 0;                                      ///< shift of its middle across the wall by the refinement
  WallCloud lidar, sonar;
  double widthDifference_m = 0;  ///< sonar minus LiDAR: the paper's table
  double offset_m = 0;           ///< mean y of the sonar minus that of the LiDAR: the misalignment the paper speaks of
  double cosineSimilarity = 0;   ///< mean over the sonar points
  double hellinger = 0;
  std::vector<double> y_m;  ///< bin centres
};

/// The paper's four metrics of two point clouds of one wall.
///
/// Choices where the paper is silent: the origin is the middle of the segment on the LiDAR's line (Huber's
/// robust regression of y on x over the points above the water); a correspondence is a sonar point with the LiDAR point
/// nearest to it in (x, y), since above and below water share no z, and its similarity is the cosine of the angle
/// between the two position vectors in the wall's frame; width is the largest minus the smallest y after trimming; the
/// density is that of y, with Gaussian kernels and Scott's bandwidth for each cloud, at bin centres over the joint
/// range of both.
/// @throws core::InputError if the segment has no length or a cloud has fewer than 20 points on it
WallReport compareWall(const std::vector<Eigen::Vector3d>& lidar_map, const std::vector<Eigen::Vector3d>& sonar_map,
                       const WallOptions& options);

}  // namespace s2s::eval
