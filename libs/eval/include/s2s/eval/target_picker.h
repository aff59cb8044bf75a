#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "s2s/eval/control_points.h"

namespace s2s::eval {

struct TargetPickerOptions {
  double searchRadius_m = 1;     ///< about where a target is expected
  double targetRadius_m = 0.35;  ///< a target's returns lie this near to its middle
  double minIntensity = 150;     ///< of a retro-reflective return; Ouster's scale ends diffuse white at 100
  int minPoints = 5;             ///< bright returns that make a target
};

struct TargetPick {
  std::string id;
  std::uint64_t points = 0;                            ///< bright returns that were averaged
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< their middle; the expected place if there are too few
  bool found = false;
  double spread_m = 0;  ///< rms distance of the returns from their middle
};

/// Finds the middles of retro-reflective targets near expected places from the bright points of a LiDAR layer.
class TargetPicker {
 public:
  /// @param expected ids and places in the frame of the points
  TargetPicker(std::vector<NamedPoint> expected, const TargetPickerOptions& options);

  void add(const Eigen::Vector3d& p, double intensity);

  /// One entry for each expected target, in their order: the centre of the densest group of bright returns (mean shift
  /// with a flat window of the target's radius, begun at every return), halfway between the extremes along each
  /// principal axis, since returns are not spread evenly over a target.
  std::vector<TargetPick> picks() const;

 private:
  TargetPick pick(const NamedPoint& expected, const std::vector<Eigen::Vector3d>& bright) const;

  std::vector<NamedPoint> expected_;
  TargetPickerOptions options_;
  std::vector<std::vector<Eigen::Vector3d>> bright_;  ///< by expected target
};

/// Refines places in the map, or surveyed points brought into it, to the middles of targets in lidar.ply.
struct PickOptions {
  TargetPickerOptions picker;
  std::string pointsFile;   ///< CSV of places: in the world frame if `truthFolder` is set, else in the map frame
  std::string truthFolder;  ///< if not empty, places are brought into the map by the true trajectory
};

/// @throws core::InputError if a file or folder cannot be used
std::vector<TargetPick> pickTargets(const std::string& mapFolder, const PickOptions& options);

/// The targets found, as CSV with the header id,x,y,z that `control --picks` reads.
std::string picksCsv(const std::vector<TargetPick>& picks);

}  // namespace s2s::eval
