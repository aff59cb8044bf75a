#pragma once

#include <cmath>

#include "s2s/products/ply_reader.h"

namespace s2s::eval {

/// Adds a box given by two corners, twelve triangles of one object.
inline void addBox(products::PlyMesh& mesh, const Eigen::Vector3d& low, const Eigen::Vector3d& high, int object) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                               (i & 4) != 0 ? high.z() : low.z());
  constexpr std::uint32_t kQuads[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                          {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
  for (const auto& q : kQuads) {
    mesh.triangles.push_back({first + q[0], first + q[1], first + q[2]});
    mesh.triangles.push_back({first + q[0], first + q[2], first + q[3]});
    mesh.object.insert(mesh.object.end(), 2, object);
  }
}

/// Adds the rectangle [x0, x1] x [y0, y1] with heights z = height(x, y) at a grid of corners `step` apart.
template <class Height>
void addTerrain(products::PlyMesh& mesh, double x0, double x1, double y0, double y1, double step, Height&& height,
                int object) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto nx = static_cast<std::uint32_t>(std::lround((x1 - x0) / step));
  const auto ny = static_cast<std::uint32_t>(std::lround((y1 - y0) / step));
  for (std::uint32_t j = 0; j <= ny; ++j)
    for (std::uint32_t i = 0; i <= nx; ++i)
      mesh.vertices.emplace_back(x0 + i * step, y0 + j * step, height(x0 + i * step, y0 + j * step));
  for (std::uint32_t j = 0; j < ny; ++j)
    for (std::uint32_t i = 0; i < nx; ++i) {
      const std::uint32_t a = first + j * (nx + 1) + i, b = a + nx + 1;
      mesh.triangles.push_back({a, a + 1, b + 1});
      mesh.triangles.push_back({a, b + 1, b});
      mesh.object.insert(mesh.object.end(), 2, object);
    }
}

/// A sphere of `rings` x 2 `rings` facets, corners on the sphere.
inline products::PlyMesh sphereMesh(const Eigen::Vector3d& centre, double radius, int rings) {
  products::PlyMesh mesh;
  const int sectors = 2 * rings;
  for (int i = 0; i <= rings; ++i)
    for (int k = 0; k < sectors; ++k) {
      const double polar = M_PI * i / rings, azimuth = 2 * M_PI * k / sectors;
      mesh.vertices.push_back(centre + radius * Eigen::Vector3d(std::sin(polar) * std::cos(azimuth),
                                                                std::sin(polar) * std::sin(azimuth), std::cos(polar)));
    }
  const auto at = [&](int i, int k) { return static_cast<std::uint32_t>(i * sectors + k % sectors); };
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < sectors; ++k) {
      mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  return mesh;
}

}  // namespace s2s::eval
