#include <cmath>

#include "s2s/sim/random.h"
#include "s2s/sim/shapes.h"

namespace s2s::sim {

using Eigen::Vector2d;
using Eigen::Vector3d;

TriangleMesh makeBox(const Vector3d& size_m) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.addVertex(
        0.5 * Vector3d((i & 1 ? 1 : -1) * size_m.x(), (i & 2 ? 1 : -1) * size_m.y(), (i & 4 ? 1 : -1) * size_m.z()));
  mesh.addQuad(0, 2, 3, 1);
  mesh.addQuad(4, 5, 7, 6);
  mesh.addQuad(0, 1, 5, 4);
  mesh.addQuad(2, 6, 7, 3);
  mesh.addQuad(0, 4, 6, 2);
  mesh.addQuad(1, 3, 7, 5);
  return mesh;
}

TriangleMesh makeCylinder(double length_m, double radius_m, int sides) {
  return makeTube({{-0.5 * length_m, 0, 0}, {0.5 * length_m, 0, 0}}, radius_m, sides);
}

TriangleMesh makeSphere(double radius_m, int rings) {
  TriangleMesh mesh;
  const int columns = 2 * rings + 1;
  for (int r = 0; r <= rings; ++r)
    for (int c = 0; c < columns; ++c) {
      const double polar = M_PI * r / rings, azimuth = 2 * M_PI * c / (columns - 1);
      mesh.addVertex(radius_m * Vector3d(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                                         std::cos(polar)));
    }
  mesh.addGrid(0, static_cast<std::size_t>(rings) + 1, static_cast<std::size_t>(columns));
  return mesh;
}

TriangleMesh makeTorus(double ringRadius_m, double tubeRadius_m, int ringSides, int tubeSides) {
  TriangleMesh mesh;
  for (int r = 0; r <= ringSides; ++r)
    for (int t = 0; t <= tubeSides; ++t) {
      const double around = 2 * M_PI * r / ringSides, tube = 2 * M_PI * t / tubeSides;
      const double radius = ringRadius_m + tubeRadius_m * std::cos(tube);
      mesh.addVertex({radius * std::cos(around), radius * std::sin(around), tubeRadius_m * std::sin(tube)});
    }
  mesh.addGrid(0, static_cast<std::size_t>(ringSides) + 1, static_cast<std::size_t>(tubeSides) + 1);
  return mesh;
}

TriangleMesh makeTube(const std::vector<Vector3d>& path, double radius_m, int sides) {
  TriangleMesh mesh;
  const std::size_t n = path.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vector3d along = (path[std::min(i + 1, n - 1)] - path[i > 0 ? i - 1 : 0]).normalized();
    const Vector3d reference = std::abs(along.z()) < 0.9 ? Vector3d::UnitZ() : Vector3d::UnitX();
    const Vector3d u = along.cross(reference).normalized(), v = along.cross(u);
    for (int s = 0; s <= sides; ++s) {
      const double angle = 2 * M_PI * s / sides;
      mesh.addVertex(path[i] + radius_m * (std::cos(angle) * u + std::sin(angle) * v));
    }
  }
  const auto ring = static_cast<std::uint32_t>(sides) + 1;
  mesh.addGrid(0, n, ring);
  for (const std::size_t end : {std::size_t{0}, n - 1}) {
    const std::uint32_t center = mesh.addVertex(path[end]);
    const auto first = static_cast<std::uint32_t>(end) * ring;
    for (std::uint32_t s = 0; s + 1 < ring; ++s) mesh.addTriangle(center, first + s, first + s + 1);
  }
  return mesh;
}

TriangleMesh makeTerrain(const SeabedField& seabed, const Vector2d& min_m, const Vector2d& max_m, double resolution_m) {
  TriangleMesh mesh;
  const Vector2d size = max_m - min_m;
  const auto columns = static_cast<std::size_t>(std::ceil(size.x() / resolution_m)) + 1;
  const auto rows = static_cast<std::size_t>(std::ceil(size.y() / resolution_m)) + 1;
  mesh.vertices.reserve(rows * columns);
  mesh.triangles.reserve(2 * rows * columns);
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t c = 0; c < columns; ++c) {
      const double x = min_m.x() + size.x() * static_cast<double>(c) / static_cast<double>(columns - 1);
      const double y = min_m.y() + size.y() * static_cast<double>(r) / static_cast<double>(rows - 1);
      mesh.addVertex({x, y, seabed.height_m(x, y)});
    }
  mesh.addGrid(0, rows, columns);
  return mesh;
}

TriangleMesh makeStone(double radius_m, std::uint64_t seed) {
  TriangleMesh mesh = makeSphere(1, 6);
  Random random(seed);
  const Vector3d stretch(random.uniform(0.7, 1.3), random.uniform(0.7, 1.3), random.uniform(0.5, 1.0));
  for (auto& v : mesh.vertices) {
    // Bumps are a function of the direction, so the seam and the poles stay closed.
    const auto cell = [](float x) { return static_cast<std::int64_t>(std::lround(3 * x)); };
    const double bump = 0.85 + 0.3 * hashUniform(seed, cell(v.x()), cell(v.y()), cell(v.z()));
    v = (radius_m * bump * stretch.cwiseProduct(v.cast<double>())).cast<float>();
  }
  return mesh;
}

}  // namespace s2s::sim
