#include "s2s/sim/scene_loader.h"

#include "s2s/core/error.h"
#include "s2s/core/option_table.h"
#include "s2s/sim/random.h"
#include "s2s/sim/shapes.h"
#include "scene_objects.h"

namespace s2s::sim {

namespace {

using core::ConfigError;
using core::IniFile;
using core::OptionTable;
using Eigen::Vector3d;

std::string nameAfter(const std::string& section, const std::string& prefix) { return section.substr(prefix.size()); }

SeabedField loadSeabed(IniFile& ini, std::uint64_t seed) {
  SeabedOptions o;
  OptionTable()
      .add("height_m", o.height_m, "mean height of the seabed at the origin")
      .add("slope_x", o.slopeX, "rise over run along x")
      .add("slope_y", o.slopeY, "rise over run along y")
      .add("channel_depth_m", o.channelDepth_m, "additional depth along y = 0")
      .add("channel_half_width_m", o.channelHalfWidth_m, "width of the channel's bell", core::positive())
      .add("ripple_height_m", o.rippleHeight_m, "ripples, crest to trough", core::atLeast(0))
      .add("ripple_length_m", o.rippleLength_m, "wavelength of the ripples", core::positive())
      .addDegrees("ripple_direction_deg", o.rippleDirection_rad, "direction across the crests")
      .add("roughness_m", o.roughness_m, "standard deviation of the relief", core::atLeast(0))
      .add("roughness_length_m", o.roughnessLength_m, "largest wavelength of the relief", core::positive())
      .load(ini, "seabed");
  std::vector<SeabedFeature> features;
  for (const auto& section : ini.sectionsStartingWith("seabed_feature.")) {
    SeabedFeature f;
    OptionTable()
        .add("x_m", f.center_m.x(), "centre")
        .add("y_m", f.center_m.y(), "centre")
        .add("radius_m", f.radius_m, "standard deviation of the bell", core::positive())
        .add("height_m", f.height_m, "height of a mound, negative for a pit")
        .load(ini, section);
    features.push_back(f);
  }
  return SeabedField(o, features, seed);
}

std::vector<Material> builtInMaterials() {
  // Lambert coefficients after Urick 1983, ch. 8, and APL-UW TR 9407; reflectivities at 865 nm, rounded.
  return {{"mud", -33, 0.10, false},        {"sand", -27, 0.25, false},     {"gravel", -20, 0.25, false},
          {"stone", -16, 0.30, false},      {"concrete", -17, 0.40, false}, {"brick", -18, 0.45, false},
          {"steel", -10, 0.25, false},      {"rubber", -20, 0.08, false},   {"wood", -18, 0.35, false},
          {"fibreglass", -17, 0.60, false}, {"leaf", -30, 0.50, false},     {"asphalt", -20, 0.15, false},
          {"grass", -30, 0.45, false},      {"retro", -20, 1.00, true}};
}

std::vector<Material> loadMaterials(IniFile& ini) {
  std::vector<Material> materials = builtInMaterials();
  for (const auto& section : ini.sectionsStartingWith("material.")) {
    Material m;
    m.name = nameAfter(section, "material.");
    OptionTable()
        .add("backscatter_db", m.backscatter_db, "Lambert coefficient 10 log10(mu)", {-80, 10})
        .add("reflectivity", m.reflectivity, "diffuse reflectivity in the infrared", {0, 1})
        .add("retro", m.retro, "retro-reflective")
        .load(ini, section);
    materials.push_back(m);
  }
  return materials;
}

/// A reflecting board around a control point, facing along `yaw_rad`.
SceneObject makeBoard(const ControlPoint& point, double size_m, double yaw_rad, std::size_t material) {
  constexpr double kThickness_m = 0.01;
  SceneObject board{"board_" + point.id, ObjectKind::Target, material, makeBox({kThickness_m, size_m, size_m})};
  const Vector3d& p = point.position_m;
  board.mesh.transform(core::isometryFromXyzYpr(p.x(), p.y(), p.z(), yaw_rad, 0, 0));
  return board;
}

void loadControlPoints(IniFile& ini, Scene& scene) {
  std::size_t retro = 0;
  while (scene.materials[retro].name != "retro") ++retro;
  for (const auto& section : ini.sectionsStartingWith("control_point.")) {
    ControlPoint p;
    double boardSize_m = 0.4, yaw_rad = 0;
    p.id = nameAfter(section, "control_point.");
    OptionTable()
        .add("x_m", p.position_m.x(), "world position")
        .add("y_m", p.position_m.y(), "world position")
        .add("z_m", p.position_m.z(), "world position")
        .add("board_size_m", boardSize_m, "side of a reflecting board around it; 0: none", core::atLeast(0))
        .addDegrees("board_yaw_deg", yaw_rad, "the way the board faces")
        .load(ini, section);
    scene.controlPoints.push_back(p);
    if (boardSize_m > 0) scene.objects.push_back(makeBoard(p, boardSize_m, yaw_rad, retro));
  }
}

std::vector<Experiment> loadExperiments(IniFile& ini) {
  std::vector<Experiment> experiments;
  for (const auto& section : ini.sectionsStartingWith("experiment.")) {
    Experiment e;
    if (!core::parseInt(nameAfter(section, "experiment."), e.number))
      throw ConfigError("an experiment is named by a number", ini.where(section, ""), "write e.g. [experiment.1]");
    std::vector<double> coordinates;
    OptionTable()
        .add("description", e.description, "one line for people")
        .add("speed_mps", e.speed_mps, "planned speed", {0.05, 5})
        .addList("waypoints_m", coordinates, "x y of each waypoint in turn")
        .load(ini, section);
    if (coordinates.size() < 4 || coordinates.size() % 2 != 0)
      throw ConfigError("waypoints are pairs of numbers, two pairs at least", ini.where(section, "waypoints_m"),
                        "give x y x y …");
    for (std::size_t i = 0; i < coordinates.size(); i += 2)
      e.waypoints_m.emplace_back(coordinates[i], coordinates[i + 1]);
    experiments.push_back(e);
  }
  return experiments;
}

}  // namespace

Scene loadScene(IniFile& ini) {
  Scene scene;
  int seed = 1;
  OptionTable()
      .add("name", scene.name, "name of the scene")
      .add("seed", seed, "seed of everything that is random in the scene itself")
      .load(ini, "scene");
  scene.seabed = loadSeabed(ini, mixBits(static_cast<std::uint64_t>(seed)));
  scene.materials = loadMaterials(ini);
  scene.experiments = loadExperiments(ini);
  std::uint64_t objectSeed = mixBits(static_cast<std::uint64_t>(seed) + 1000);
  for (const auto& section : ini.sectionsStartingWith("object."))
    scene.objects.push_back(loadObject(ini, section, scene, objectSeed = mixBits(objectSeed)));
  if (scene.objects.empty()) throw ConfigError("the scene has no objects", ini.name(), "add sections [object.NAME]");
  loadControlPoints(ini, scene);
  for (const auto& section : ini.sectionsStartingWith("vessel_part."))
    scene.vesselParts.push_back(loadObject(ini, section, scene, objectSeed = mixBits(objectSeed)));
  return scene;
}

}  // namespace s2s::sim
