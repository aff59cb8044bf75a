#include "s2s/eval/target_picker.h"

#include <gtest/gtest.h>

#include <random>

#include "s2s/core/transform.h"
#include "sample_survey.h"

using namespace s2s;
using namespace s2s::eval;

namespace {

/// Returns on a board of 0.4 m x 0.4 m, three times as dense on its left half, 1 cm of noise across it.
template <class Visit>
void scanBoard(const core::Isometry& T_frame_board, Visit&& visit) {
  std::mt19937 random(4);
  std::normal_distribution<double> noise(0, 0.01);
  std::uniform_real_distribution<double> side(-0.2, 0.2), left(-0.2, 0.0);
  for (int i = 0; i < 400; ++i)
    visit(T_frame_board * Eigen::Vector3d(noise(random), i % 2 == 0 ? side(random) : left(random), side(random)));
}

}  // namespace

TEST(TargetPicker, UnevenlySeenBoard_IsPickedInItsMiddle) {
  const core::Isometry T = core::isometryFromXyzYpr(12.3, -4.5, 2.1, 0.7, 0, 0);
  TargetPicker picker({{"a", T.translation() + Eigen::Vector3d(0.3, -0.2, 0.1), 0}}, {});
  scanBoard(T, [&](const Eigen::Vector3d& p) { picker.add(p, 255); });
  const TargetPick pick = picker.picks().at(0);
  ASSERT_TRUE(pick.found);
  EXPECT_EQ(pick.points, 400u);
  // Of 400 random returns (100 on the sparse side) the outermost are some 0.2 m / 100 from the edge. The principal axes
  // of a nearly square cloud may be turned; then the extremes are corners. The mean would be off by 0.05 m.
  EXPECT_LT((pick.position - T.translation()).norm(), 0.02);
}

TEST(TargetPicker, DarkAndFarPoints_AreNotTaken) {
  TargetPicker picker({{"a", {0, 0, 0}, 0}}, {});
  scanBoard(core::isometryFromXyzYpr(0, 0, 0, 0, 0, 0), [&](const Eigen::Vector3d& p) {
    picker.add(p, 255);
    picker.add(p + Eigen::Vector3d(0.02, 0.3, 0), 80);
    picker.add(p + Eigen::Vector3d(0, 3, 0), 255);
  });
  for (int i = 0; i < 4; ++i) picker.add({0.8, 0.1, 0.01 * i}, 200);  // a second, smaller bright thing
  EXPECT_EQ(picker.picks().at(0).points, 400u);
}

TEST(TargetPicker, TooFewBrightPoints_AreNoTarget) {
  TargetPicker picker({{"a", {0, 0, 0}, 0}, {"b", {10, 0, 0}, 0}}, {});
  for (int i = 0; i < 4; ++i) picker.add({0.01 * i, 0, 0}, 255);
  for (int i = 0; i < 5; ++i) picker.add({10 + 0.01 * i, 0, 0}, 255);
  const auto picks = picker.picks();
  EXPECT_FALSE(picks[0].found);
  EXPECT_TRUE(picks[1].found);
  EXPECT_EQ(picksCsv(picks).substr(0, 11), "id,x,y,z\nb,");
}

TEST(PickTargets, BoardInTheMap_IsFoundFromItsPlaceInTheWorld) {
  const ScratchFolder folder;
  const SampleSurvey survey(folder);
  survey.writeTruth();
  survey.writeMap(0);
  products::PlyPointWriter lidar(folder.path("out/lidar.ply"));
  scanBoard(SampleSurvey::T_map_world() * core::isometryFromXyzYpr(5, 19.9, 2, -M_PI / 2, 0, 0),
            [&](const Eigen::Vector3d& p) {
              map::MapPoint point;
              point.p_map = p;
              point.intensity = 255;
              lidar.add(point);
            });
  lidar.finish();
  PickOptions options;
  options.pointsFile = folder.write("points.csv", "id,x,y,z,sigma\nboard,5,19.9,2,0.01\n");
  options.truthFolder = survey.truth();
  const auto picks = pickTargets(survey.out(), options);
  ASSERT_TRUE(picks.at(0).found);
  EXPECT_LT((picks[0].position - SampleSurvey::T_map_world() * Eigen::Vector3d(5, 19.9, 2)).norm(), 0.02);
}
