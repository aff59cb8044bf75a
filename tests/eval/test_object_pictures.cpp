#include "s2s/eval/object_pictures.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "s2s/core/error.h"
#include "scratch_folder.h"
#include "test_meshes.h"

using namespace s2s;
using namespace s2s::eval;

namespace {

/// A bar 20 m long and 0.5 m high on a level bed, in pieces of half a metre.
TruthFolder world() {
  TruthFolder truth;
  truth.objects = {{0, {"bed", "seabed", "mud"}}, {1, {"bar", "object", "steel"}}};
  addTerrain(
      truth.world, -20, 20, -5, 5, 1, [](double, double) { return -4.0; }, 0);
  for (int i = -20; i < 20; ++i) addBox(truth.world, {0.5 * i, -0.5, -4}, {0.5 * i + 0.5, 0.5, -3.5}, 1);
  return truth;
}

/// Pixels that are clearly more red than blue: the upper half of the colours.
int redPixels(const cv::Mat& picture) {
  int count = 0;
  for (const auto& pixel : cv::Mat_<cv::Vec3b>(picture)) count += pixel[2] > pixel[0] + 60 ? 1 : 0;
  return count;
}

}  // namespace

TEST(ObjectPictures, PointsOnTopOfAnObject_AreAsHighAsTheTruthBesideThem) {
  const ScratchFolder folder;
  ObjectFinder finder(world(), 0.1);
  finder.keepPoints(1.0);
  for (int i = 0; i <= 400; ++i)
    for (int j = 0; j <= 50; ++j) finder.add(map::Layer::Stereo, {-2 + 0.01 * i, -0.5 + 0.02 * j, -3.5});
  writeObjectPictures(finder, folder.path());
  const cv::Mat picture = cv::imread(folder.path() + "/object_bar.png");
  ASSERT_FALSE(picture.empty());
  ASSERT_FALSE(cv::imread(folder.path() + "/objects.jpg").empty());
  // The view from above is the upper of two, the map its left half and the truth its right one. All of the face has
  // points, 2 cm apart and drawn 1.5 cm and at least 2 pixels wide: most of the face is red on both sides.
  const int half = picture.cols / 2, rows = picture.rows / 3;
  const int mapped = redPixels(picture({0, 0, half, rows})), truth = redPixels(picture({half, 0, half, rows}));
  EXPECT_GT(truth, 1000);
  EXPECT_GT(mapped, truth / 3);
  // A piece of 3 to 4 m with margins is less than 5 m wide: 1 m of bar is at least a fifth of the picture's width.
  EXPECT_GT(truth, 3 * (half / 5) * (half / 5));
}

TEST(ObjectPictures, ObjectWithoutPoints_HasNone) {
  const ScratchFolder folder;
  ObjectFinder finder(world(), 0.1);
  finder.keepPoints(1.0);
  writeObjectPictures(finder, folder.path());
  EXPECT_FALSE(std::filesystem::exists(folder.path() + "/object_bar.png"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() + "/objects.jpg"));
}
