#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "s2s/sim/mesh.h"
#include "s2s/sim/seabed_field.h"

namespace s2s::sim {

/// How a surface answers sound and light.
struct Material {
  std::string name;
  /// Lambert coefficient 10 log10(mu) of backscatter: the strength per square metre at normal incidence (Urick 1983,
  /// ch. 8; mud about -35, sand -28, gravel -20, rock and concrete -15, steel -10).
  double backscatter_db = -25;
  double reflectivity = 0.3;  ///< diffuse reflectivity for the LiDAR's infrared, 1: a white Lambertian surface
  bool retro = false;         ///< retro-reflective foil: far above 1 in the direction of the source
};

/// What an object is, as `objects.csv` names it. Rubble is stone heaped on the seabed: the bed of who sails there.
enum class ObjectKind { Seabed, Wall, Structure, Vessel, Vegetation, Ground, Object, Target, Rubble };
const char* kindName(ObjectKind kind);

struct SceneObject {
  std::string name;
  ObjectKind kind = ObjectKind::Structure;
  std::size_t material = 0;  ///< index into Scene::materials
  TriangleMesh mesh;         ///< in the world frame
};

struct ControlPoint {
  std::string id;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
};

/// One planned survey: the vessel's way and speed.
struct Experiment {
  int number = 0;
  std::string description;
  std::vector<Eigen::Vector2d> waypoints_m;
  double speed_mps = 1.25;
};

/// A world: z up, the mean water surface at z = 0. An object's id in all truth files is its index in `objects`.
struct Scene {
  std::string name;
  SeabedField seabed;
  std::vector<Material> materials;
  std::vector<SceneObject> objects;
  std::vector<SceneObject> vesselParts;  ///< of the surveying vessel, in its own frame
  std::vector<ControlPoint> controlPoints;
  std::vector<Experiment> experiments;

  /// @throws core::ConfigError listing the experiments there are
  const Experiment& experiment(int number) const;
};

}  // namespace s2s::sim
