#include <gtest/gtest.h>

#include "s2s/core/error.h"
#include "sim_support.h"
#include "temp_folder.h"

using namespace s2s;
using namespace s2s::test;
using Eigen::Vector3d;

namespace {

/// Volume by the divergence theorem; the sign is that of the winding.
double volume(const sim::TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    sum += mesh.vertices[t[0]].cast<double>().dot(
               mesh.vertices[t[1]].cast<double>().cross(mesh.vertices[t[2]].cast<double>())) /
           6;
  return std::abs(sum);
}

void write(const std::string& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

const char kObj[] =
    "# a pyramid\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 1\n"
    "f 4 3 2 1\nf 1/1 2/2 5/3\nf 2 3 5\nf 3 4 5\nf -2 -5 -1\n";

}  // namespace

TEST(Shapes, ClosedShapes_HaveTheirVolume) {
  EXPECT_NEAR(volume(sim::makeBox({2, 3, 4})), 24, 1e-5);
  // Polygons lie inside their circles: the facets' volume is smaller by a few per cent, never larger.
  EXPECT_NEAR(volume(sim::makeSphere(2, 32)) / (4.0 / 3 * M_PI * 8), 0.99, 0.01);
  EXPECT_NEAR(volume(sim::makeTorus(1, 0.25, 64, 32)) / (2 * M_PI * M_PI * 0.0625), 0.99, 0.01);
}

TEST(Shapes, Terrain_FollowsTheSeabed) {
  sim::SeabedOptions o;
  o.height_m = -3;
  o.slopeX = 0.1;
  o.slopeY = -0.05;
  const sim::SeabedField seabed(o, {{{2, 1}, 1.5, -0.7}}, 1);
  for (const auto& v : sim::makeTerrain(seabed, {-5, -5}, {5, 5}, 0.5).vertices) {
    const double dx = v.x() - 2, dy = v.y() - 1;
    const double expected = -3 + 0.1 * v.x() - 0.05 * v.y() - 0.7 * std::exp(-0.5 * (dx * dx + dy * dy) / 2.25);
    EXPECT_NEAR(v.z(), expected, 1e-5);  // single precision
  }
}

TEST(SeabedField, Roughness_HasTheStandardDeviationAskedFor) {
  sim::SeabedOptions o;
  o.height_m = 0;
  o.roughness_m = 0.2;
  o.roughnessLength_m = 1;
  const sim::SeabedField seabed(o, {}, 3);
  double sum = 0, squares = 0;
  constexpr int kSide = 150;
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j) {
      const double h = seabed.height_m(0.73 * i, 0.81 * j);
      sum += h;
      squares += h * h;
    }
  // About 10^4 independent cells give 1 %; blended value noise is only about normal in variance, hence 10 %.
  EXPECT_NEAR(sum / (kSide * kSide), 0, 0.01);
  EXPECT_NEAR(std::sqrt(squares / (kSide * kSide)), 0.2, 0.02);
}

TEST(Shapes, Wall_StandsOnItsLine_WithItsProfileBehind) {
  sim::WallOptions o;
  o.style = sim::WallStyle::SheetPile;
  o.pileDepth_m = 0.4;
  const auto mesh = sim::makeWall({{0, 0}, {24, 0}}, o, 1);  // visible side towards +y
  float front = -1, back = 1;
  for (const auto& v : mesh.vertices) {
    front = std::max(front, v.y());
    back = std::min(back, v.y());
  }
  EXPECT_NEAR(front, 0, 1e-6);
  EXPECT_NEAR(back, -0.4, 1e-6);
}

TEST(RayCaster, RangesAndNormals_AreThoseOfGeometry) {
  const sim::Scene scene = sceneOf({makeFloor(-4, 50), moved(sim::makeSphere(1, 64), 10, 0, 0)});
  const sim::RayCaster caster(scene.objects);
  const auto down = caster.cast(sim::Ray{{0, 0, 0}, Eigen::Vector3f(3, 0, -4) / 5, 100});
  EXPECT_EQ(down.object, 0u);
  EXPECT_NEAR(down.range_m, 5, 1e-5);
  EXPECT_NEAR(down.normal.z(), 1, 1e-6);
  const auto ahead = caster.cast(sim::Ray{{0, 0, 0}, {1, 0, 0}, 100});
  EXPECT_EQ(ahead.object, 1u);
  EXPECT_NEAR(ahead.range_m, 9, 3e-3);  // facets of 1/64 of a half circle lie up to 2.4 mm inside
  EXPECT_FALSE(caster.cast(sim::Ray{{0, 0, 0}, {0, 0, 1}, 100}).hit());
  EXPECT_FALSE(caster.cast(sim::Ray{{0, 0, 0}, {1, 0, 0}, 8.5f}).hit());
}

TEST(RayCaster, ManyRays_GiveWhatSingleRaysGive) {
  const sim::Scene scene = sceneOf({makeFloor(-4, 50), moved(sim::makeSphere(1), 5, 1, -3)});
  const sim::RayCaster caster(scene.objects);
  std::vector<sim::Ray> rays;
  sim::Random random(3);
  for (int i = 0; i < 700; ++i) {
    const Eigen::Vector3d d(random.normal(), random.normal(), random.normal());
    rays.push_back({{0, 0, 0}, d.normalized().cast<float>(), 60});
  }
  std::vector<sim::RayHit> hits;
  caster.cast(rays, hits);
  ASSERT_EQ(hits.size(), rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto single = caster.cast(rays[i]);
    EXPECT_EQ(hits[i].object, single.object);
    EXPECT_NEAR(hits[i].range_m, single.range_m, 1e-4);
  }
}

TEST(MeshFile, ObjWithPolygonsAndNegativeIndices_IsRead) {
  const TempFolder folder;
  write(folder.file("a.obj"), kObj);
  const auto mesh = sim::loadMesh(folder.file("a.obj"));
  EXPECT_EQ(mesh.vertices.size(), 5u);
  EXPECT_EQ(mesh.triangles.size(), 6u);
  EXPECT_NEAR(volume(mesh), 1.0 / 3, 1e-6);
}

TEST(MeshFile, PlyAsciiAndBinary_GiveTheSameMesh) {
  const TempFolder folder;
  const std::string counts =
      "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n";
  write(folder.file("a.ply"), "ply\nformat ascii 1.0\n" + counts + "0 0 0\n1 0 0\n0 2.5 0\n3 0 1 2\n");
  std::string binary = "ply\nformat binary_little_endian 1.0\n" + counts;
  const float xyz[9] = {0, 0, 0, 1, 0, 0, 0, 2.5f, 0};
  const std::int32_t corners[3] = {0, 1, 2};
  binary.append(reinterpret_cast<const char*>(xyz), sizeof xyz);
  binary.push_back(3);
  binary.append(reinterpret_cast<const char*>(corners), sizeof corners);
  write(folder.file("b.ply"), binary);
  const auto a = sim::loadMesh(folder.file("a.ply")), b = sim::loadMesh(folder.file("b.ply"));
  ASSERT_EQ(a.vertices.size(), 3u);
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.triangles, b.triangles);
  write(folder.file("cut.ply"), binary.substr(0, binary.size() - 5));
  EXPECT_THROW(sim::loadMesh(folder.file("cut.ply")), core::InputError);
  write(folder.file("damaged.ply"), "ply\nformat ascii 1.0\n" + counts + "0 0 0\n1 0 0\n0 2.5 0\n-3 0 1 2\n");
  EXPECT_THROW(sim::loadMesh(folder.file("damaged.ply")), core::InputError);
}

TEST(MeshFile, MissingUnknownOrDamaged_IsRefused) {
  const TempFolder folder;
  EXPECT_THROW(sim::loadMesh(folder.file("none.obj")), core::InputError);
  write(folder.file("a.stl"), "solid\n");
  EXPECT_THROW(sim::loadMesh(folder.file("a.stl")), core::InputError);
  write(folder.file("bad.obj"), "v 0 0 0\nv 1 0 0\nf 1 2 9\n");
  EXPECT_THROW(sim::loadMesh(folder.file("bad.obj")), core::InputError);
  write(folder.file("empty.obj"), "v 0 0 0\n");
  EXPECT_THROW(sim::loadMesh(folder.file("empty.obj")), core::InputError);
}
