#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "s2s/core/transform.h"

namespace s2s::sim {

/// A triangle soup with shared vertices; metres, in whatever frame its maker says.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;

  std::uint32_t addVertex(const Eigen::Vector3d& p);
  void addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) { triangles.push_back({a, b, c}); }
  /// Two triangles; corners in order around the quad.
  void addQuad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);
  /// Triangles over a grid of `rows` x `columns` vertices that was added row by row, the first at `first`.
  void addGrid(std::uint32_t first, std::size_t rows, std::size_t columns);
  void append(const TriangleMesh& other);
  void transform(const core::Isometry& T);
  bool empty() const { return triangles.empty(); }
};

/// Reads a Wavefront OBJ (faces of any number of corners, no materials) or a PLY (ASCII or binary little-endian)
/// file by its extension.
/// @throws core::InputError if the file is missing, of another kind or damaged
TriangleMesh loadMesh(const std::string& path);

}  // namespace s2s::sim
