#include <cctype>
#include <cstring>
#include <fstream>
#include <sstream>

#include "s2s/core/error.h"
#include "s2s/sim/mesh.h"

namespace s2s::sim {

namespace {

[[noreturn]] void refuse(const std::string& fault, const std::string& where) {
  throw core::InputError(fault, where, "export the mesh as OBJ, or as ASCII or binary little-endian PLY");
}

/// A face of any number of corners as a fan of triangles.
void addFace(TriangleMesh& mesh, const std::vector<std::int64_t>& corners, const std::string& where) {
  if (corners.size() < 3) refuse("a face has fewer than three corners", where);
  for (const std::int64_t c : corners)
    if (c < 0 || c >= static_cast<std::int64_t>(mesh.vertices.size()))
      refuse("a face names a vertex that is not there", where);
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    mesh.addTriangle(static_cast<std::uint32_t>(corners[0]), static_cast<std::uint32_t>(corners[i]),
                     static_cast<std::uint32_t>(corners[i + 1]));
}

TriangleMesh loadObj(std::istream& in, const std::string& path) {
  TriangleMesh mesh;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    const std::string where = path + ":" + std::to_string(number);
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "v") {
      Eigen::Vector3d p;
      if (!(words >> p.x() >> p.y() >> p.z())) refuse("a vertex does not parse", where);
      mesh.addVertex(p);
    } else if (kind == "f") {
      std::vector<std::int64_t> corners;
      for (std::string corner; words >> corner;) {
        const std::int64_t index = std::strtoll(corner.c_str(), nullptr, 10);
        corners.push_back(index > 0 ? index - 1 : static_cast<std::int64_t>(mesh.vertices.size()) + index);
      }
      addFace(mesh, corners, where);
    }
  }
  return mesh;
}

/// Corners of a face, or entries of another list; a longer one is damage and would take all memory.
constexpr double kMostCorners = 1e6;

struct PlyProperty {
  std::string name, type, countType;  // countType is set for lists
};
struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;
};
struct PlyHeader {
  bool binary = false;
  std::vector<PlyElement> elements;
};

PlyHeader readPlyHeader(std::istream& in, const std::string& path) {
  PlyHeader header;
  std::string line;
  std::getline(in, line);
  if (line.rfind("ply", 0) != 0) refuse("this is no PLY file", path);
  while (std::getline(in, line)) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "end_header") return header;
    if (word == "format") {
      words >> word;
      if (word != "ascii" && word != "binary_little_endian") refuse("unsupported PLY format '" + word + "'", path);
      header.binary = word != "ascii";
    } else if (word == "element") {
      PlyElement element;
      words >> element.name >> element.count;
      header.elements.push_back(element);
    } else if (word == "property" && !header.elements.empty()) {
      PlyProperty p;
      words >> p.type;
      if (p.type == "list") words >> p.countType >> p.type;
      words >> p.name;
      header.elements.back().properties.push_back(p);
    }
  }
  refuse("the PLY header does not end", path);
}

template <class T>
double readBinary(std::istream& in) {
  T value{};
  in.read(reinterpret_cast<char*>(&value), sizeof value);
  return static_cast<double>(value);
}

double readPlyValue(std::istream& in, bool binary, const std::string& type, const std::string& path) {
  if (!binary) {
    double value = 0;
    in >> value;
    return value;
  }
  if (type == "float" || type == "float32") return readBinary<float>(in);
  if (type == "double" || type == "float64") return readBinary<double>(in);
  if (type == "uchar" || type == "uint8") return readBinary<std::uint8_t>(in);
  if (type == "char" || type == "int8") return readBinary<std::int8_t>(in);
  if (type == "ushort" || type == "uint16") return readBinary<std::uint16_t>(in);
  if (type == "short" || type == "int16") return readBinary<std::int16_t>(in);
  if (type == "uint" || type == "uint32") return readBinary<std::uint32_t>(in);
  if (type == "int" || type == "int32") return readBinary<std::int32_t>(in);
  refuse("unknown PLY type '" + type + "'", path);
}

TriangleMesh loadPly(std::istream& in, const std::string& path) {
  const PlyHeader header = readPlyHeader(in, path);
  TriangleMesh mesh;
  for (const PlyElement& element : header.elements)
    for (std::size_t i = 0; i < element.count; ++i) {
      Eigen::Vector3d p = Eigen::Vector3d::Zero();
      for (const PlyProperty& property : element.properties) {
        if (property.countType.empty()) {
          const double value = readPlyValue(in, header.binary, property.type, path);
          if (property.name == "x") p.x() = value;
          if (property.name == "y") p.y() = value;
          if (property.name == "z") p.z() = value;
          continue;
        }
        const double count = readPlyValue(in, header.binary, property.countType, path);
        if (!(count >= 0 && count <= kMostCorners)) refuse("a list of the file has an impossible length", path);
        std::vector<std::int64_t> corners(static_cast<std::size_t>(count));
        for (auto& c : corners) c = static_cast<std::int64_t>(readPlyValue(in, header.binary, property.type, path));
        if (!in) refuse("the file ends too early", path);
        if (element.name == "face" && property.name.rfind("vertex_ind", 0) == 0)
          addFace(mesh, corners, path + ", face " + std::to_string(i));
      }
      if (!in) refuse("the file ends too early", path);
      if (element.name == "vertex") mesh.addVertex(p);
    }
  return mesh;
}

}  // namespace

TriangleMesh loadMesh(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) refuse("the mesh file cannot be read", path);
  std::string extension = path.substr(path.find_last_of('.') + 1);
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (extension != "obj" && extension != "ply") refuse("unknown mesh format '." + extension + "'", path);
  TriangleMesh mesh = extension == "obj" ? loadObj(in, path) : loadPly(in, path);
  if (mesh.empty()) refuse("the mesh has no faces", path);
  return mesh;
}

}  // namespace s2s::sim
