#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "error_text.h"
#include "s2s/core/error.h"
#include "s2s/products/trajectory_files.h"
#include "temp_folder.h"

namespace s2s::products {
namespace {

using test::errorText;
using test::readBytes;
using test::TempFolder;
using test::writeBytes;
using testing::HasSubstr;

core::Trajectory randomTrajectory() {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> angle(-3.1, 3.1), place(-500, 500);
  core::Trajectory trajectory;
  for (int i = 0; i < 50; ++i)
    trajectory.append(1'733'400'000'000'000'001 + 100'000'007LL * i,
                      core::isometryFromXyzYpr(place(random), place(random), place(random), angle(random),
                                               angle(random) / 2, angle(random)));
  return trajectory;
}

TEST(TrajectoryFiles, Tum_RoundTripKeepsTimesExactlyAndPosesToNanometres) {
  const TempFolder folder;
  const auto trajectory = randomTrajectory();
  writeTum(folder.file("t.tum"), trajectory);
  const auto back = readTum(folder.file("t.tum"));
  ASSERT_EQ(back.size(), trajectory.size());
  for (std::size_t i = 0; i < back.size(); ++i) {
    EXPECT_EQ(back.poses()[i].time, trajectory.poses()[i].time);
    // Nine decimals of a metre; quaternions have twelve decimals.
    EXPECT_LT((back.poses()[i].T.translation() - trajectory.poses()[i].T.translation()).norm(), 1e-9);
    EXPECT_LT((back.poses()[i].T.linear() - trajectory.poses()[i].T.linear()).norm(), 1e-11);
  }
}

TEST(TrajectoryFiles, Tum_LineHasTheStatedForm) {
  const TempFolder folder;
  core::Trajectory trajectory;
  // Yaw 90 degrees: q = (0, 0, sin 45, cos 45).
  trajectory.append(1'733'400'000'000'000'005, core::isometryFromXyzYpr(1, -2, 3.5, M_PI / 2, 0, 0));
  writeTum(folder.file("t.tum"), trajectory);
  EXPECT_EQ(readBytes(folder.file("t.tum")),
            "1733400000.000000005 1.000000000 -2.000000000 3.500000000 0.000000000000 0.000000000000 0.707106781187 "
            "0.707106781187\n");
}

TEST(TrajectoryFiles, TumOfOthers_CommentsExponentsAndFewDecimalsAreRead) {
  const TempFolder folder;
  writeBytes(folder.file("t.tum"),
             "# time x y z qx qy qz qw\n2.5 1 2 3 0 0 0.7071 0.7071\n\n1.0e0 -1e-3 0 0 0 0 0 -1\n"
             "3.1234567896 0 0 0 0 0 0 1\n");
  const auto back = readTum(folder.file("t.tum"));
  ASSERT_EQ(back.size(), 3U);
  EXPECT_EQ(back.front().time, core::kNsPerSecond);
  EXPECT_EQ(back.poses()[1].time, 2'500'000'000);
  EXPECT_EQ(back.back().time, 3'123'456'790);
  EXPECT_NEAR(back.poses()[1].T.linear().determinant(), 1, 1e-12);  // made a unit quaternion
}

TEST(TrajectoryFiles, BadTum_NamesFileAndLine) {
  const TempFolder folder;
  writeBytes(folder.file("a.tum"), "0 0 0 0 0 0 0 1\n1 0 0 0 0 0 1\n");
  EXPECT_THAT(errorText<core::InputError>([&] { readTum(folder.file("a.tum")); }), HasSubstr("a.tum:2"));
  writeBytes(folder.file("b.tum"), "0 0 nan 0 0 0 0 1\n");
  EXPECT_THAT(errorText<core::InputError>([&] { readTum(folder.file("b.tum")); }), HasSubstr("'nan' is no number"));
  writeBytes(folder.file("c.tum"), "0 0 0 0 0 0 0 0.5\n");
  EXPECT_THAT(errorText<core::InputError>([&] { readTum(folder.file("c.tum")); }), HasSubstr("quaternion"));
  writeBytes(folder.file("d.tum"), "1733400000123456789 0 0 0 0 0 0 1\n");
  EXPECT_THAT(errorText<core::InputError>([&] { readTum(folder.file("d.tum")); }), HasSubstr("no time in seconds"));
  EXPECT_THROW(readTum(folder.file("absent.tum")), core::InputError);
}

TEST(TrajectoryFiles, Kitti_RoundTripWithTimes) {
  const TempFolder folder;
  const auto trajectory = randomTrajectory();
  writeKitti(folder.file("k.txt"), trajectory, folder.file("times.txt"));
  const auto back = readKitti(folder.file("k.txt"));
  ASSERT_EQ(back.size(), trajectory.size());
  for (std::size_t i = 0; i < back.size(); ++i)
    // Thirteen significant digits of numbers below 1000.
    EXPECT_LT((back[i].matrix() - trajectory.poses()[i].T.matrix()).norm(), 1e-9);
  EXPECT_THAT(readBytes(folder.file("times.txt")), testing::StartsWith("1733400000.000000001\n1733400000.100000008\n"));
}

TEST(TrajectoryFiles, BadKitti_NamesFileAndLine) {
  const TempFolder folder;
  writeBytes(folder.file("a.txt"), "1 0 0 0 0 1 0 0 0 0 1 0\n1 2 3\n");
  EXPECT_THAT(errorText<core::InputError>([&] { readKitti(folder.file("a.txt")); }), HasSubstr("a.txt:2"));
  writeBytes(folder.file("b.txt"), "1 0 0 0 0 1 0 0 0 0 -1 0\n");  // a mirror
  EXPECT_THAT(errorText<core::InputError>([&] { readKitti(folder.file("b.txt")); }), HasSubstr("no rotation"));
}

TEST(TrajectoryFiles, RealKittiPoses_AreRead) {
  const std::string path = std::string(S2S_DATA_DIR) + "/kitti_scans/reference_kiss_icp.txt";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is absent";
  const auto poses = readKitti(path);
  ASSERT_EQ(poses.size(), 22U);
  // The data's page gives 16.9 m over the 22 scans.
  double length = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) length += (poses[i].translation() - poses[i - 1].translation()).norm();
  EXPECT_NEAR(length, 16.9, 0.2);
}

TEST(TrajectoryFiles, UnwritableFolder_IsAnOutputError) {
  const TempFolder folder;
  writeBytes(folder.file("taken"), "x");
  EXPECT_THROW(writeTum(folder.file("taken/t.tum"), randomTrajectory()), core::OutputError);
  EXPECT_THROW(writeKitti(folder.file("taken/k.txt"), randomTrajectory()), core::OutputError);
  EXPECT_EQ(folder.fileCount(), 1U);
}

}  // namespace
}  // namespace s2s::products
