#include <cmath>

#include "s2s/sim/random.h"
#include "s2s/sim/shapes.h"

namespace s2s::sim {

using Eigen::Vector3d;

namespace {

TriangleMesh boxAt(const Vector3d& size_m, const Vector3d& center_m) {
  TriangleMesh mesh = makeBox(size_m);
  mesh.transform(core::Isometry(Eigen::Translation3d(center_m)));
  return mesh;
}

/// Half the breadth of a hull at u in [-1, 1] along it and v in [0, 1] from keel to deck.
double halfBreadth_m(const HullOptions& o, double u, double v) {
  const double sternFactor = u < 0 ? 0.3 : 1.0;  // the stern stays fuller than the bow
  const double plan = 1 - sternFactor * std::pow(std::abs(u), o.fullness);
  return 0.5 * o.beam_m * std::max(0.02, plan) * std::pow(std::max(v, 1e-3), 0.4);
}

void addLeaf(TriangleMesh& mesh, const Vector3d& center, double size_m, Random& random) {
  Vector3d normal(random.normal(), random.normal(), random.normal());
  normal.normalize();
  const Vector3d u = normal.unitOrthogonal() * 0.5 * size_m, v = normal.cross(u);
  mesh.addQuad(mesh.addVertex(center - u), mesh.addVertex(center - v), mesh.addVertex(center + u),
               mesh.addVertex(center + v));
}

}  // namespace

TriangleMesh makeHull(const HullOptions& o) {
  constexpr int kStations = 24, kLevels = 8;
  TriangleMesh mesh;
  for (const int side : {1, -1}) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int level = 0; level <= kLevels; ++level)
      for (int station = 0; station <= kStations; ++station) {
        const double u = -1 + 2.0 * station / kStations, v = static_cast<double>(level) / kLevels;
        mesh.addVertex(
            {0.5 * o.length_m * u, side * halfBreadth_m(o, u, v), -o.draft_m + v * (o.draft_m + o.freeboard_m)});
      }
    mesh.addGrid(first, kLevels + 1, kStations + 1);
  }
  const auto perSide = static_cast<std::uint32_t>((kLevels + 1) * (kStations + 1));
  const auto deck = static_cast<std::uint32_t>(kLevels * (kStations + 1));
  for (std::uint32_t i = 0; i < kStations; ++i) {
    mesh.addQuad(i, i + 1, perSide + i + 1, perSide + i);  // keel
    mesh.addQuad(deck + i, deck + i + 1, perSide + deck + i + 1, perSide + deck + i);
  }
  for (std::uint32_t level = 0; level < kLevels; ++level) {  // transom
    const std::uint32_t a = level * (kStations + 1), b = a + kStations + 1;
    mesh.addQuad(a, b, perSide + b, perSide + a);
  }
  if (o.cabinHeight_m > 0)
    mesh.append(boxAt({0.45 * o.length_m, 0.7 * o.beam_m, o.cabinHeight_m},
                      {-0.05 * o.length_m, 0, o.freeboard_m + 0.5 * o.cabinHeight_m}));
  return mesh;
}

TriangleMesh makeTree(const TreeOptions& o, std::uint64_t seed) {
  Random random(seed);
  TriangleMesh mesh = makeTube({{0, 0, 0}, {0, 0, o.trunkHeight_m + 0.5 * o.crown_m.z()}}, o.trunkRadius_m, 10);
  const Vector3d center(0, 0, o.trunkHeight_m + o.crown_m.z());
  for (int i = 0; i < o.leaves; ++i) {
    Vector3d p;
    do p = Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    while (p.squaredNorm() > 1);
    addLeaf(mesh, center + p.cwiseProduct(o.crown_m), o.leafSize_m, random);
  }
  return mesh;
}

TriangleMesh makeBuilding(const BuildingOptions& o) {
  TriangleMesh mesh = boxAt(o.size_m, {0, 0, 0.5 * o.size_m.z()});
  const auto floors = static_cast<int>(o.size_m.z() / o.floorHeight_m);
  for (const int axis : {0, 1}) {  // windows on the facades whose width runs along this axis
    const double width = o.size_m[axis], offset = 0.5 * o.size_m[1 - axis];
    const auto bays = static_cast<int>(width / o.bayWidth_m);
    for (int bay = 0; bay < bays; ++bay)
      for (int floor = 0; floor < floors; ++floor)
        for (const int side : {1, -1}) {
          Vector3d center, size;
          center[axis] = (bay + 0.5) * width / bays - 0.5 * width;
          center[1 - axis] = side * offset;
          center.z() = (floor + 0.55) * o.floorHeight_m;
          size[axis] = 0.45 * o.bayWidth_m;
          size[1 - axis] = 2 * o.relief_m;
          size.z() = 0.5 * o.floorHeight_m;
          mesh.append(boxAt(size, center));
        }
  }
  return mesh;
}

}  // namespace s2s::sim
