#include "s2s/products/ply_reader.h"

#include "ply_parser.h"

namespace s2s::products {

namespace {

void readPoints(PlyParser& parser, const PlyElement& element, const std::function<void(const PlyPoint&)>& visit) {
  const int x = element.find("x"), y = element.find("y"), z = element.find("z");
  if (x < 0 || y < 0 || z < 0) parser.fail("the PLY vertices have no x, y and z");
  const int intensity = element.find("intensity"), sigma = element.find("sigma"), time = element.find("time"),
            layer = element.find("layer"), source = element.find("source");
  parser.readElement(element, [&](const PlyRow& row) {
    PlyPoint point;
    point.p = {row.scalar(x), row.scalar(y), row.scalar(z)};
    if (intensity >= 0) point.intensity = static_cast<float>(row.scalar(intensity));
    if (sigma >= 0) point.sigma_m = static_cast<float>(row.scalar(sigma));
    if (time >= 0) point.time_s = row.scalar(time);
    if (layer >= 0) point.layer = static_cast<int>(row.scalar(layer));
    if (source >= 0) point.source = static_cast<int>(row.scalar(source));
    visit(point);
  });
}

void readFaces(PlyParser& parser, const PlyElement& element, PlyMesh& mesh) {
  int list = element.find("vertex_indices");
  if (list < 0) list = element.find("vertex_index");
  if (list < 0 || !element.properties[static_cast<std::size_t>(list)].isList)
    parser.fail("the PLY faces have no list 'vertex_indices'");
  const int object = element.find("object");
  const auto index = [&](double value) {
    if (!(value >= 0 && value < static_cast<double>(mesh.vertices.size())))
      parser.fail("a PLY face names vertex " + std::to_string(static_cast<long long>(value)) + " of " +
                  std::to_string(mesh.vertices.size()));
    return static_cast<std::uint32_t>(value);
  };
  parser.readElement(element, [&](const PlyRow& row) {
    const std::size_t begin = row.begin[static_cast<std::size_t>(list)];
    const std::size_t end = row.begin[static_cast<std::size_t>(list) + 1];
    for (std::size_t i = begin + 2; i < end; ++i) {
      mesh.triangles.push_back({index(row.values[begin]), index(row.values[i - 1]), index(row.values[i])});
      if (object >= 0) mesh.object.push_back(static_cast<std::int32_t>(row.scalar(object)));
    }
  });
}

}  // namespace

std::size_t forEachPlyPoint(const std::string& path, const std::function<void(const PlyPoint&)>& visit) {
  PlyParser parser(path);
  for (const auto& element : parser.elements()) {
    if (element.name == "vertex") {
      readPoints(parser, element, visit);
      return element.count;
    }
    parser.readElement(element, [](const PlyRow&) {});
  }
  parser.fail("the PLY file has no element 'vertex'");
}

std::vector<PlyPoint> readPlyPoints(const std::string& path) {
  std::vector<PlyPoint> points;
  forEachPlyPoint(path, [&](const PlyPoint& point) { points.push_back(point); });
  return points;
}

PlyMesh readPlyMesh(const std::string& path) {
  PlyParser parser(path);
  PlyMesh mesh;
  bool hasVertices = false;
  for (const auto& element : parser.elements()) {
    if (element.name == "vertex") {
      hasVertices = true;
      readPoints(parser, element, [&](const PlyPoint& point) { mesh.vertices.push_back(point.p); });
    } else if (element.name == "face") {
      readFaces(parser, element, mesh);
    } else {
      parser.readElement(element, [](const PlyRow&) {});
    }
  }
  if (!hasVertices) parser.fail("the PLY file has no element 'vertex'");
  return mesh;
}

}  // namespace s2s::products
