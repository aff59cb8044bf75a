#include "s2s/eval/object_presence.h"

#include <gtest/gtest.h>

#include "test_meshes.h"

using namespace s2s;
using namespace s2s::eval;

namespace {

constexpr auto kStereo = static_cast<std::size_t>(map::Layer::Stereo);

/// A seabed at -4 m for x < 0 only, a box of 0.5 m height on it that reaches 1 m beyond, and a wall.
TruthFolder world() {
  TruthFolder truth;
  truth.objects = {{0, {"bed", "seabed", "mud"}}, {1, {"box", "object", "steel"}}, {2, {"quay", "wall", "stone"}}};
  addTerrain(
      truth.world, -10, 0, -5, 5, 1, [](double, double) { return -4.0; }, 0);
  addBox(truth.world, {-1, -0.5, -4.2}, {1, 0.5, -3.5}, 1);
  addBox(truth.world, {-10, 5, -6}, {0, 6, 2}, 2);
  return truth;
}

}  // namespace

TEST(ObjectPresence, PointsAtKnownPlaces_AreSortedByDistance) {
  ObjectFinder finder(world(), 0.1);
  finder.add(map::Layer::Stereo, {-0.5, 0, -3.45});    // 0.05 m above the box
  finder.add(map::Layer::Stereo, {-0.5, 0, -3.39});    // 0.11 m above: too far
  finder.add(map::Layer::Stereo, {-1.05, 0, -3.99});   // 0.05 m beside it, but 0.01 m from the bed
  finder.add(map::Layer::Lidar, {-0.5, 0.02, -3.42});  // another layer
  finder.add(map::Layer::Stereo, {-5, 4.99, -1});      // on the quay, which is no object
  const auto presence = finder.presence();
  ASSERT_EQ(presence.size(), 1u);
  EXPECT_EQ(presence[0].name, "box");
  EXPECT_EQ(presence[0].near[kStereo], 2u);
  EXPECT_EQ(presence[0].own[kStereo], 1u);
  EXPECT_EQ(presence[0].own[static_cast<std::size_t>(map::Layer::Lidar)], 1u);
  // Heights 0.55 and 0.58 m; the 95th percentile of two lies 95 % of the way.
  EXPECT_NEAR(presence[0].mappedHeight_m, 0.55 + 0.95 * 0.03, 1e-6);
}

TEST(ObjectPresence, ObjectPartlyBesideTheSeabed_HasTheHeightOfTheRest) {
  ObjectFinder finder(world(), 0.1);
  finder.add(map::Layer::Stereo, {0.5, 0, -3.5});  // on the box where there is no seabed
  finder.add(map::Layer::Stereo, {-0.5, 0, -3.5});
  const auto presence = finder.presence();
  EXPECT_NEAR(presence[0].trueHeight_m, 0.5, 1e-6);
  EXPECT_EQ(presence[0].own[kStereo], 2u);
  EXPECT_NEAR(presence[0].mappedHeight_m, 0.5, 1e-6);
}

TEST(ObjectPresence, WorldWithoutSeabed_HasNoHeights) {
  TruthFolder truth = world();
  truth.objects[0].kind = "ground";
  ObjectFinder finder(truth, 0.1);
  finder.add(map::Layer::Stereo, {-0.5, 0, -3.5});
  const auto presence = finder.presence();
  EXPECT_EQ(presence[0].near[kStereo], 1u);
  EXPECT_TRUE(std::isnan(presence[0].trueHeight_m));
  EXPECT_TRUE(std::isnan(presence[0].mappedHeight_m));
}

TEST(ObjectPresence, HalfOfTheVisibleSurfaceWithPoints_IsHalfCovered) {
  const TruthFolder truth = world();
  const MeshQuery mesh(truth.world);
  core::Trajectory path;
  path.append(0, core::isometryFromXyzYpr(-3, -4, 0, 0, 0, 0));
  path.append(1, core::isometryFromXyzYpr(3, 4, 0, 0, 0, 0));
  ObjectFinder finder(truth, 0.1);
  finder.measureCover(mesh, path, {});
  finder.keepPoints(0.3);
  // The upper face for y < 0 only, every 5 cm; the sides stay bare.
  for (double x = -0.975; x < 1; x += 0.05)
    for (double y = -0.475; y < 0; y += 0.05) finder.add(map::Layer::Stereo, {x, y, -3.5});
  const auto presence = finder.presence();
  // Upper face 2 m2; of the sides, 2 x 2 x 0.7 and 2 x 1 x 0.7 m2 (0.5 above the bed where there is one), all that is
  // not below the bed is seen from the two places on a diagonal.
  EXPECT_GT(presence[0].seenArea_m2, 2 + 2 * 2 * 0.5);
  EXPECT_LT(presence[0].seenArea_m2, 2 + 2 * 2 * 0.7 + 2 * 1 * 0.7 + 0.3);
  // Half the upper face, 0.1 m of its other half, and the sides' upper rim of 0.1 m around that half.
  const double covered_m2 = 1 + 0.2 + 0.1 * (2 + 0.6 + 0.6);
  EXPECT_NEAR(presence[0].covered * presence[0].seenArea_m2, covered_m2, 0.15);
  EXPECT_EQ(finder.pointsOf(0).size(), 400u);
}
