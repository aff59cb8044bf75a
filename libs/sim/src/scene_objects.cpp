#include "scene_objects.h"

#include <cmath>

#include "s2s/core/error.h"
#include "s2s/core/option_table.h"
#include "s2s/sim/random.h"
#include "s2s/sim/shapes.h"

namespace s2s::sim {

namespace {

using core::ConfigError;
using core::IniFile;
using core::Isometry;
using core::OptionTable;
using core::positive;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// What a maker of shapes needs to know about its section.
struct ObjectSection {
  IniFile& ini;
  const std::string& name;
  const Scene& scene;
  std::uint64_t seed;

  void load(OptionTable& table) const { table.load(ini, name); }
  [[noreturn]] void refuse(const std::string& fault, const std::string& key, const std::string& remedy) const {
    throw ConfigError(fault, ini.where(name, key), remedy);
  }
};

/// Where an object stands and how often.
struct Placement {
  Isometry T_world_object = Isometry::Identity();
  bool onSeabed = false;
  int repeat = 1;
  Vector3d step_m = Vector3d::Zero();

  void addTo(OptionTable& table) {
    table.addPose("pose", T_world_object, "place in the world")
        .add("on_seabed", onSeabed, "the pose's z counts from the seabed at its x, y")
        .add("repeat", repeat, "number of copies", {1, 10000})
        .add("repeat_dx_m", step_m.x(), "from copy to copy")
        .add("repeat_dy_m", step_m.y(), "from copy to copy")
        .add("repeat_dz_m", step_m.z(), "from copy to copy");
  }
  TriangleMesh place(const TriangleMesh& shape, const SeabedField& seabed) const {
    TriangleMesh all;
    for (int i = 0; i < repeat; ++i) {
      Isometry T = T_world_object;
      T.translation() += i * step_m;
      if (onSeabed) T.translation().z() += seabed.height_m(T.translation().x(), T.translation().y());
      TriangleMesh copy = shape;
      copy.transform(T);
      all.append(copy);
    }
    return all;
  }
};

/// Loads the shape's own options with those of its placement, makes it and places it.
template <class Make>
TriangleMesh makePlaced(const ObjectSection& s, OptionTable& table, const Make& make) {
  Placement placement;
  placement.addTo(table);
  s.load(table);
  return placement.place(make(), s.scene.seabed);
}

void addSize(OptionTable& table, Vector3d& size) {
  table.add("size_x_m", size.x(), "extent along the object's x", positive())
      .add("size_y_m", size.y(), "extent along the object's y", positive())
      .add("size_z_m", size.z(), "extent along the object's z", positive());
}

TriangleMesh loadBox(const ObjectSection& s) {
  Vector3d size(1, 1, 1);
  OptionTable table;
  addSize(table, size);
  return makePlaced(s, table, [&] { return makeBox(size); });
}

TriangleMesh loadCylinder(const ObjectSection& s) {
  double length = 1, radius = 0.25;
  OptionTable table;
  table.add("length_m", length, "along the object's x", positive()).add("radius_m", radius, "radius", positive());
  return makePlaced(s, table, [&] { return makeCylinder(length, radius); });
}

TriangleMesh loadSphere(const ObjectSection& s) {
  double radius = 0.5;
  OptionTable table;
  table.add("radius_m", radius, "radius", positive());
  return makePlaced(s, table, [&] { return makeSphere(radius); });
}

TriangleMesh loadTorus(const ObjectSection& s) {
  double ring = 0.25, tube = 0.09;
  OptionTable table;
  table.add("ring_radius_m", ring, "from the centre to the middle of the tube", positive())
      .add("tube_radius_m", tube, "radius of the tube", positive());
  return makePlaced(s, table, [&] { return makeTorus(ring, tube); });
}

TriangleMesh loadHull(const ObjectSection& s) {
  HullOptions o;
  OptionTable table;
  table.add("length_m", o.length_m, "length", positive())
      .add("beam_m", o.beam_m, "breadth", positive())
      .add("draft_m", o.draft_m, "depth below the waterline", positive())
      .add("freeboard_m", o.freeboard_m, "deck above the waterline", positive())
      .add("fullness", o.fullness, "exponent of the waterline; larger is boxier", {1, 50})
      .add("cabin_height_m", o.cabinHeight_m, "height of a cabin, 0: none", core::atLeast(0));
  return makePlaced(s, table, [&] { return makeHull(o); });
}

TriangleMesh loadTree(const ObjectSection& s) {
  TreeOptions o;
  OptionTable table;
  table.add("trunk_height_m", o.trunkHeight_m, "foot to crown", positive())
      .add("trunk_radius_m", o.trunkRadius_m, "radius of the trunk", positive())
      .add("crown_radius_m", o.crown_m.x(), "horizontal semi-axis of the crown", positive())
      .add("crown_height_m", o.crown_m.z(), "vertical semi-axis of the crown", positive())
      .add("leaves", o.leaves, "number of leaves", {0, 1e6})
      .add("leaf_size_m", o.leafSize_m, "diagonal of a leaf", positive());
  return makePlaced(s, table, [&] {
    o.crown_m.y() = o.crown_m.x();
    return makeTree(o, s.seed);
  });
}

TriangleMesh loadBuilding(const ObjectSection& s) {
  BuildingOptions o;
  OptionTable table;
  addSize(table, o.size_m);
  table.add("bay_width_m", o.bayWidth_m, "distance of windows", positive())
      .add("floor_height_m", o.floorHeight_m, "distance of floors", positive())
      .add("relief_m", o.relief_m, "how far window frames stand out", positive());
  return makePlaced(s, table, [&] { return makeBuilding(o); });
}

TriangleMesh loadMeshObject(const ObjectSection& s) {
  std::string file;
  double scale = 1;
  OptionTable table;
  table.add("file", file, "OBJ or PLY file, relative to the INI").add("scale", scale, "metres a unit", positive());
  return makePlaced(s, table, [&] {
    const std::size_t slash = s.ini.name().find_last_of('/');
    const std::string folder = slash == std::string::npos ? "" : s.ini.name().substr(0, slash + 1);
    TriangleMesh mesh = loadMesh(file.rfind('/', 0) == 0 ? file : folder + file);
    for (auto& v : mesh.vertices) v *= static_cast<float>(scale);
    return mesh;
  });
}

TriangleMesh loadTerrain(const ObjectSection& s) {
  Vector2d min(-10, -10), max(10, 10);
  double resolution = 0.2;
  OptionTable table;
  table.add("min_x_m", min.x(), "extent")
      .add("max_x_m", max.x(), "extent")
      .add("min_y_m", min.y(), "extent")
      .add("max_y_m", max.y(), "extent")
      .add("resolution_m", resolution, "mesh size", positive());
  s.load(table);
  if (!(min.array() < max.array()).all()) s.refuse("the extent is empty", "max_x_m", "make max larger than min");
  return makeTerrain(s.scene.seabed, min, max, resolution);
}

TriangleMesh loadWall(const ObjectSection& s) {
  WallOptions o;
  std::vector<double> line;
  OptionTable table;
  table.addList("line_m", line, "x y of each corner; the visible side is on the left of the way along it")
      .addChoice("style", o.style,
                 {{"plain", WallStyle::Plain}, {"stone", WallStyle::Stone}, {"sheet_pile", WallStyle::SheetPile}},
                 "kind of face")
      .add("bottom_m", o.bottom_m, "lower edge")
      .add("top_m", o.top_m, "upper edge")
      .add("block_length_m", o.blockLength_m, "stone: block length", positive())
      .add("block_height_m", o.blockHeight_m, "stone: block height", positive())
      .add("joint_depth_m", o.jointDepth_m, "stone: depth of joints", core::atLeast(0))
      .add("roughness_m", o.roughness_m, "stone: how far blocks stand out", core::atLeast(0))
      .add("pile_length_m", o.pileLength_m, "sheet pile: length of a wave", positive())
      .add("pile_depth_m", o.pileDepth_m, "sheet pile: depth of the profile", core::atLeast(0))
      .add("resolution_m", o.resolution_m, "stone: mesh size", positive());
  s.load(table);
  if (line.size() < 4 || line.size() % 2 != 0) s.refuse("a wall needs two corners or more", "line_m", "give x y x y …");
  if (o.top_m <= o.bottom_m) s.refuse("the wall's top is below its bottom", "top_m", "raise it");
  std::vector<Vector2d> corners;
  for (std::size_t i = 0; i < line.size(); i += 2) corners.emplace_back(line[i], line[i + 1]);
  return makeWall(corners, o, s.seed);
}

/// Points of a tube every `spacing` along its corners, laid on the seabed if asked.
std::vector<Vector3d> tubePath(const std::vector<double>& corners, bool onSeabed, const SeabedField& seabed) {
  std::vector<Vector3d> path;
  const std::size_t n = corners.size() / 3;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const Vector3d a(&corners[3 * i]), b(&corners[3 * (i + 1)]);
    constexpr double kSpacing_m = 0.25;
    const int steps = onSeabed ? std::max(1, static_cast<int>((b - a).norm() / kSpacing_m)) : 1;
    for (int k = i == 0 ? 0 : 1; k <= steps; ++k) path.push_back(a + (b - a) * k / steps);
  }
  if (onSeabed)
    for (Vector3d& p : path) p.z() += seabed.height_m(p.x(), p.y());
  return path;
}

TriangleMesh loadTube(const ObjectSection& s) {
  std::vector<double> corners;
  double radius = 0.1;
  OptionTable table;
  table.addList("path_m", corners, "x y z of each corner; with on_seabed the path follows the seabed at height z")
      .add("radius_m", radius, "radius", positive());
  Placement placement;
  placement.addTo(table);
  s.load(table);
  if (corners.size() < 6 || corners.size() % 3 != 0)
    s.refuse("a tube needs two corners or more", "path_m", "give x y z x y z …");
  const TriangleMesh tube = makeTube(tubePath(corners, placement.onSeabed, s.scene.seabed), radius);
  placement.onSeabed = false;  // the path has been laid already
  return placement.place(tube, s.scene.seabed);
}

TriangleMesh loadStones(const ObjectSection& s) {
  double x = 0, y = 0, spread = 3, minRadius = 0.1, maxRadius = 0.4, pile = 0;
  int count = 30;
  OptionTable table;
  table.add("x_m", x, "centre")
      .add("y_m", y, "centre")
      .add("spread_m", spread, "standard deviation of the places", positive())
      .add("count", count, "number of stones", {1, 100000})
      .add("min_radius_m", minRadius, "smallest stone", positive())
      .add("max_radius_m", maxRadius, "largest stone", positive())
      .add("pile_height_m", pile, "height of the heap in its middle", core::atLeast(0));
  s.load(table);
  Random random(s.seed);
  TriangleMesh all;
  for (int i = 0; i < count; ++i) {
    const double u = random.normal(), v = random.normal();
    const Vector2d p(x + spread * u, y + spread * v);
    const double radius = minRadius * std::pow(maxRadius / minRadius, random.uniform());
    TriangleMesh stone = makeStone(radius, random.bits());
    const double lift = pile * std::exp(-0.5 * (u * u + v * v)) * random.uniform() + 0.3 * radius;
    stone.transform(core::isometryFromXyzYpr(p.x(), p.y(), s.scene.seabed.height_m(p.x(), p.y()) + lift,
                                             random.uniform(0, 2 * M_PI), random.uniform(-0.5, 0.5), 0));
    all.append(stone);
  }
  return all;
}

using Loader = TriangleMesh (*)(const ObjectSection&);
const std::vector<std::pair<std::string, Loader>>& shapeLoaders() {
  static const std::vector<std::pair<std::string, Loader>> kLoaders = {
      {"box", loadBox},         {"cylinder", loadCylinder}, {"sphere", loadSphere},     {"torus", loadTorus},
      {"hull", loadHull},       {"tree", loadTree},         {"building", loadBuilding}, {"mesh", loadMeshObject},
      {"terrain", loadTerrain}, {"wall", loadWall},         {"tube", loadTube},         {"stones", loadStones}};
  return kLoaders;
}

std::size_t materialIndex(const ObjectSection& s, const std::string& name) {
  std::vector<std::string> known;
  // The last one of a name wins, so that a scene can redefine a built-in material.
  for (std::size_t i = s.scene.materials.size(); i-- > 0;) {
    if (s.scene.materials[i].name == name) return i;
    known.push_back(s.scene.materials[i].name);
  }
  const std::string near = core::nearestWord(name, known);
  s.refuse("unknown material '" + name + "'", "material",
           near.empty() ? "define it in a section [material." + name + "]" : "did you mean '" + near + "'?");
}

}  // namespace

SceneObject loadObject(IniFile& ini, const std::string& section, const Scene& scene, std::uint64_t seed) {
  const ObjectSection s{ini, section, scene, seed};
  std::string material = "concrete";
  Loader loader = nullptr;
  SceneObject object;
  object.name = section.substr(section.find('.') + 1);
  OptionTable()
      .addChoice("shape", loader, shapeLoaders(), "what it is")
      .addChoice("kind", object.kind,
                 {{"seabed", ObjectKind::Seabed},
                  {"wall", ObjectKind::Wall},
                  {"structure", ObjectKind::Structure},
                  {"vessel", ObjectKind::Vessel},
                  {"vegetation", ObjectKind::Vegetation},
                  {"ground", ObjectKind::Ground},
                  {"object", ObjectKind::Object},
                  {"target", ObjectKind::Target},
                  {"rubble", ObjectKind::Rubble}},
                 "class in objects.csv")
      .add("material", material, "name of a built-in material or of a section [material.NAME]")
      .load(ini, section);
  if (!loader) s.refuse("the object has no shape", "shape", "add e.g. 'shape = box'");
  object.material = materialIndex(s, material);
  object.mesh = loader(s);
  return object;
}

}  // namespace s2s::sim
