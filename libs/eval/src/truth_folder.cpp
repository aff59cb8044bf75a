#include "s2s/eval/truth_folder.h"

#include <filesystem>

#include "s2s/core/error.h"
#include "s2s/eval/csv.h"
#include "s2s/products/trajectory_files.h"

namespace s2s::eval {

namespace fs = std::filesystem;

namespace {

constexpr const char* kRemedy = "give the folder 'truth' that simulate-survey writes";

std::string fileIn(const std::string& folder, const std::string& name) {
  if (!fs::is_directory(folder)) throw core::InputError("there is no such folder", folder, kRemedy);
  const fs::path file = fs::path(folder) / name;
  if (!fs::is_regular_file(file)) throw core::InputError("the folder holds no " + name, folder, kRemedy);
  return file.string();
}

std::map<int, WorldObject> readObjects(const std::string& path) {
  const CsvTable table = CsvTable::load(path, {"id", "name", "kind", "material"});
  std::map<int, WorldObject> objects;
  for (std::size_t row = 0; row < table.rows(); ++row)
    objects[static_cast<int>(table.number(row, "id"))] = {table.text(row, "name"), table.text(row, "kind"),
                                                          table.text(row, "material")};
  return objects;
}

template <class Keep>
products::PlyMesh partOf(const products::PlyMesh& mesh, Keep&& keep) {
  products::PlyMesh part;
  part.vertices = mesh.vertices;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if (keep(mesh.object[i])) {
      part.triangles.push_back(mesh.triangles[i]);
      part.object.push_back(mesh.object[i]);
    }
  return part;
}

}  // namespace

products::PlyMesh TruthFolder::partOfKind(const std::string& kind) const {
  return partOf(world, [&](int object) { return objects.at(object).kind == kind; });
}

products::PlyMesh TruthFolder::partOfObject(int object) const {
  return partOf(world, [&](int candidate) { return candidate == object; });
}

products::PlyMesh TruthFolder::groundUnderWater() const {
  return partOf(world, [&](int object) {
    const std::string& kind = objects.at(object).kind;
    return kind == "seabed" || kind == "object" || kind == "rubble";
  });
}

TruthFolder readTruthFolder(const std::string& path) {
  TruthFolder truth;
  truth.trajectory = readTruthTrajectory(path);
  const std::string worldFile = fileIn(path, "world.ply");
  truth.world = products::readPlyMesh(worldFile);
  truth.objects = readObjects(fileIn(path, "objects.csv"));
  if (truth.world.triangles.empty() || truth.world.object.size() != truth.world.triangles.size())
    throw core::InputError("the mesh has no faces with the property 'object'", worldFile, kRemedy);
  for (const int object : truth.world.object)
    if (truth.objects.count(object) == 0)
      throw core::InputError("the mesh names object " + std::to_string(object) + ", which objects.csv does not list",
                             worldFile, "take world.ply and objects.csv from the same run");
  return truth;
}

core::Trajectory readTruthTrajectory(const std::string& path) {
  return products::readTum(fileIn(path, "trajectory.tum"));
}

}  // namespace s2s::eval
