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
