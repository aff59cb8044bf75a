#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "s2s/sim/mesh.h"
#include "s2s/sim/seabed_field.h"

namespace s2s::sim {

/// Makers of triangle meshes. Shapes that are placed by a pose are made around their own origin.

/// A box centred at the origin.
TriangleMesh makeBox(const Eigen::Vector3d& size_m);

/// A closed cylinder along x, centred at the origin.
TriangleMesh makeCylinder(double length_m, double radius_m, int sides = 24);

TriangleMesh makeSphere(double radius_m, int rings = 16);

/// A torus around z: a tyre lying flat.
TriangleMesh makeTorus(double ringRadius_m, double tubeRadius_m, int ringSides = 32, int tubeSides = 12);

/// A round tube along a polyline, closed at its ends.
TriangleMesh makeTube(const std::vector<Eigen::Vector3d>& path, double radius_m, int sides = 12);

/// A grid over [min, max] in x and y with the seabed's heights.
TriangleMesh makeTerrain(const SeabedField& seabed, const Eigen::Vector2d& min_m, const Eigen::Vector2d& max_m,
                         double resolution_m);

enum class WallStyle { Plain, Stone, SheetPile };

struct WallOptions {
  WallStyle style = WallStyle::Plain;
  double bottom_m = -6, top_m = 1.4;                 ///< world heights
  double blockLength_m = 0.9, blockHeight_m = 0.45;  ///< stone: size of the blocks
  double jointDepth_m = 0.04;                        ///< stone: depth of the joints
  double roughness_m = 0.015;                        ///< stone: how far blocks stand out or back (standard deviation)
  double pileLength_m = 1.2;                         ///< sheet pile: length of one wave
  double pileDepth_m = 0.35;                         ///< sheet pile: depth of the profile, behind the line
  double resolution_m = 0.15;                        ///< stone: mesh size
};

/// A wall along a polyline in the xy plane; its visible side is on the left of the line's direction, and the line is
/// the foremost face of a plain wall.
TriangleMesh makeWall(const std::vector<Eigen::Vector2d>& line, const WallOptions& options, std::uint64_t seed);

struct HullOptions {
  double length_m = 8, beam_m = 2.6, draft_m = 0.5, freeboard_m = 0.9;
  double fullness = 2.5;     ///< exponent of the waterline's shape; larger is boxier
  double cabinHeight_m = 0;  ///< a cabin over the middle of the deck; 0: none
};

/// A boat's hull lofted from its sections, deck closed; origin amidships on the waterline, bow toward +x.
TriangleMesh makeHull(const HullOptions& options);

struct TreeOptions {
  double trunkHeight_m = 2.5, trunkRadius_m = 0.18;
  Eigen::Vector3d crown_m{2.2, 2.2, 2.6};  ///< semi-axes of the crown
  int leaves = 2500;
  double leafSize_m = 0.12;
};

/// A trunk and a crown of randomly oriented leaves, so that a beam passes with a probability that falls with the path
/// through the crown; origin at the trunk's foot.
TriangleMesh makeTree(const TreeOptions& options, std::uint64_t seed);

struct BuildingOptions {
  Eigen::Vector3d size_m{20, 10, 12};
  double bayWidth_m = 3, floorHeight_m = 3.2;
  double relief_m = 0.15;  ///< how far window frames stand out of the facade
};

/// A block with rows of windows on its four facades; origin at the centre of its base.
TriangleMesh makeBuilding(const BuildingOptions& options);

/// One irregular stone (a distorted sphere) of about the given radius.
TriangleMesh makeStone(double radius_m, std::uint64_t seed);

}  // namespace s2s::sim
