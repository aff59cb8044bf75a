#include "s2s/sim/scene.h"

#include "s2s/core/error.h"

namespace s2s::sim {

const char* kindName(ObjectKind kind) {
  switch (kind) {
    case ObjectKind::Seabed:
      return "seabed";
    case ObjectKind::Wall:
      return "wall";
    case ObjectKind::Structure:
      return "structure";
    case ObjectKind::Vessel:
      return "vessel";
    case ObjectKind::Vegetation:
      return "vegetation";
    case ObjectKind::Ground:
      return "ground";
    case ObjectKind::Object:
      return "object";
    case ObjectKind::Target:
      return "target";
    case ObjectKind::Rubble:
      return "rubble";
  }
  return "?";
}

const Experiment& Scene::experiment(int number) const {
  std::string known;
  for (const Experiment& e : experiments) {
    if (e.number == number) return e;
    known += "\n  " + std::to_string(e.number) + "  " + e.description;
  }
  throw core::ConfigError("scene '" + name + "' has no experiment " + std::to_string(number), "--experiment",
                          "choose one of:" + known);
}

}  // namespace s2s::sim
