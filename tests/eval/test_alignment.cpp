#include "s2s/eval/alignment.h"

#include <gtest/gtest.h>

#include <random>

using namespace s2s;
using namespace s2s::eval;

namespace {

using Points = std::vector<Eigen::Vector3d>;

const core::Isometry kMotion = core::isometryFromXyzYpr(310.5, -72.25, 4.5, 2.1, -0.4, 0.3);

Points scattered(int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-20, 20);
  Points points;
  for (int i = 0; i < count; ++i) points.emplace_back(uniform(random), uniform(random), uniform(random));
  return points;
}

Points moved(const Points& points, const core::Isometry& T) {
  Points result;
  for (const auto& p : points) result.push_back(T * p);
  return result;
}

}  // namespace

TEST(AlignPoints, MovedPoints_GiveTheMotion) {
  for (const int count : {3, 4, 50}) {
    const Points source = scattered(count);
    const PointAlignment alignment = alignPoints(source, moved(source, kMotion));
    EXPECT_EQ(alignment.status, AlignmentStatus::Ok);
    // Coordinates of some 300 m carry 6e-14 m of rounding; the decomposition a few times that.
    EXPECT_LT((alignment.T_target_source.matrix() - kMotion.matrix()).norm(), 1e-10) << count;
    EXPECT_LT(alignment.rmse_m, 1e-11);
  }
}

TEST(AlignPoints, MirroredPoints_GiveARotationAllTheSame) {
  const Points source = scattered(20);
  Points target;
  for (const auto& p : source) target.emplace_back(-p.x(), p.y(), p.z());
  // A reflection would fit exactly; only proper rotations are allowed.
  EXPECT_NEAR(alignPoints(source, target).T_target_source.linear().determinant(), 1, 1e-12);
}

TEST(AlignPoints, NoisyPoints_NoNearbyMotionFitsBetter) {
  const Points source = scattered(12);
  Points target = moved(source, kMotion);
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.2);
  for (auto& p : target) p += Eigen::Vector3d(noise(random), noise(random), noise(random));
  const PointAlignment best = alignPoints(source, target);
  const auto cost = [&](const core::Isometry& T) {
    double sum = 0;
    for (std::size_t i = 0; i < source.size(); ++i) sum += (T * source[i] - target[i]).squaredNorm();
    return sum;
  };
  for (int axis = 0; axis < 6; ++axis)
    for (const double step : {-1e-3, 1e-3}) {
      core::Isometry d = core::Isometry::Identity();
      if (axis < 3)
        d.translation()[axis] = step;
      else
        d.linear() = core::expSo3(step * Eigen::Vector3d::Unit(axis - 3));
      EXPECT_LT(cost(best.T_target_source), cost(best.T_target_source * d)) << axis << ' ' << step;
    }
}

TEST(AlignPoints, TooFewOrCollinearPoints_AreNamedSo) {
  const Points two = scattered(2);
  EXPECT_EQ(alignPoints(two, two).status, AlignmentStatus::TooFewPoints);
  EXPECT_EQ(alignPoints({}, {}).status, AlignmentStatus::TooFewPoints);
  const Points line = {{0, 0, 0}, {10, 10, 1}, {20, 20, 2}, {-5, -5, -0.5}};
  EXPECT_EQ(alignPoints(line, moved(line, kMotion)).status, AlignmentStatus::Collinear);
  const Points same = {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}};
  EXPECT_EQ(alignPoints(same, same).status, AlignmentStatus::Collinear);
}

TEST(AlignPoints, CollinearPoints_AreStillBroughtOntoEachOther) {
  const Points line = {{0, 0, 0}, {10, 10, 1}, {20, 20, 2}};
  EXPECT_LT(alignPoints(line, moved(line, kMotion)).rmse_m, 1e-10);
}

TEST(AlignPoses, StraightPath_FixesTheRollThatPositionsLeaveOpen) {
  std::vector<core::Isometry> source, target;
  for (int i = 0; i < 50; ++i) {
    source.push_back(core::isometryFromXyzYpr(i, 0, 0, 0.01 * i, 0, 0));
    target.push_back(kMotion * source.back());
  }
  EXPECT_LT((alignPoses(source, target, 10).matrix() - kMotion.matrix()).norm(), 1e-10);
}

TEST(AlignPoses, OnePose_IsEnough) {
  const core::Isometry T = core::isometryFromXyzYpr(1, 2, 3, 0.1, 0.2, 0.3);
  EXPECT_LT((alignPoses({T}, {kMotion * T}, 10).matrix() - kMotion.matrix()).norm(), 1e-10);
}
