#include "s2s/eval/map_folder.h"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "s2s/core/error.h"
#include "s2s/products/grid_files.h"
#include "s2s/products/trajectory_files.h"

namespace s2s::eval {

namespace fs = std::filesystem;

MapFolder::MapFolder(std::string path) : path_(std::move(path)) {
  const char* remedy = "give the output folder of seabed-sky-map";
  if (!fs::is_directory(path_)) throw core::InputError("there is no such folder", path_, remedy);
  if (!existing("trajectory.tum")) throw core::InputError("the folder holds no trajectory.tum", path_, remedy);
}

std::optional<std::string> MapFolder::existing(const std::string& name) const {
  const fs::path file = fs::path(path_) / name;
  if (!fs::is_regular_file(file)) return std::nullopt;
  return file.string();
}

core::Trajectory MapFolder::trajectory() const {
  return products::readTum((fs::path(path_) / "trajectory.tum").string());
}

std::optional<core::Trajectory> MapFolder::odometry() const {
  const auto file = existing("odometry.tum");
  if (!file) return std::nullopt;
  return products::readTum(*file);
}

std::optional<std::string> MapFolder::layerFile(map::Layer layer) const {
  const std::string name = std::string(map::layerName(layer)) + ".ply";
  const auto plain = existing(name);
  return plain ? plain : existing("map_" + name);
}

std::optional<products::HeightGrid> MapFolder::seabed() const {
  const auto file = existing("seabed.tif");
  if (!file) return std::nullopt;
  return products::readGrid(*file);
}

std::optional<double> MapFolder::waterHeight_m() const {
  const auto file = existing("summary.json");
  if (!file) return std::nullopt;
  std::ifstream in(*file);
  const auto summary = nlohmann::json::parse(in, nullptr, false);
  if (summary.is_discarded() || !summary.is_object())
    throw core::InputError("the summary is damaged", *file, "make the map again, or state the value as an option");
  const auto value = summary.find("water_height_m");
  if (value == summary.end() || !value->is_number()) return std::nullopt;
  return value->get<double>();
}

}  // namespace s2s::eval
