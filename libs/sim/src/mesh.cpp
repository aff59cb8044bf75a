#include "s2s/sim/mesh.h"

namespace s2s::sim {

std::uint32_t TriangleMesh::addVertex(const Eigen::Vector3d& p) {
  vertices.push_back(p.cast<float>());
  return static_cast<std::uint32_t>(vertices.size() - 1);
}

void TriangleMesh::addQuad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  addTriangle(a, b, c);
  addTriangle(a, c, d);
}

void TriangleMesh::addGrid(std::uint32_t first, std::size_t rows, std::size_t columns) {
  for (std::size_t r = 0; r + 1 < rows; ++r)
    for (std::size_t c = 0; c + 1 < columns; ++c) {
      const auto corner = static_cast<std::uint32_t>(first + r * columns + c);
      const auto width = static_cast<std::uint32_t>(columns);
      addQuad(corner, corner + 1, corner + width + 1, corner + width);
    }
}

void TriangleMesh::append(const TriangleMesh& other) {
  const auto base = static_cast<std::uint32_t>(vertices.size());
  vertices.insert(vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& t : other.triangles) addTriangle(t[0] + base, t[1] + base, t[2] + base);
}

void TriangleMesh::transform(const core::Isometry& T) {
  for (auto& v : vertices) v = (T * v.cast<double>()).cast<float>();
}

}  // namespace s2s::sim
