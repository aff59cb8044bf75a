#pragma once

#include <map>
#include <string>

#include "s2s/core/trajectory.h"
#include "s2s/products/ply_reader.h"

namespace s2s::eval {

/// What a numbered part of the true world is.
struct WorldObject {
  std::string name;
  std::string kind;  ///< seabed, wall, structure, vessel, vegetation, ground, object, target
  std::string material;
};

/// The truth of a simulated survey, as simulate-survey writes it. World frame: z up, z = 0 is the mean water surface.
struct TruthFolder {
  core::Trajectory trajectory;  ///< T_world_vehicle
  products::PlyMesh world;      ///< with an object number for each triangle
  std::map<int, WorldObject> objects;

  /// The part of the world whose objects are of a kind; all vertices are kept.
  products::PlyMesh partOfKind(const std::string& kind) const;
  /// The part that is one object.
  products::PlyMesh partOfObject(int object) const;
  /// The ground under water: seabed, rubble, and the objects that lie on it.
  products::PlyMesh groundUnderWater() const;
};

/// Reads trajectory.tum, world.ply and objects.csv.
/// @throws core::InputError if the folder or one of them is missing or damaged, or a triangle's object is not listed
TruthFolder readTruthFolder(const std::string& path);

/// Only the trajectory.
/// @throws core::InputError
core::Trajectory readTruthTrajectory(const std::string& path);

}  // namespace s2s::eval
