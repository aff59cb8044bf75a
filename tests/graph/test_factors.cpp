#include <gtest/gtest.h>

#include "fixed_random.h"
#include "s2s/graph/factors/between_factor.h"
#include "s2s/graph/factors/gnss_factor.h"
#include "s2s/graph/factors/gravity_factor.h"
#include "s2s/graph/factors/waterline_factor.h"

using namespace s2s;
using namespace s2s::graph;
using graph::test::diagonalCovariance;
using graph::test::FixedRandom;
using graph::test::perturbed;

namespace {

using Block = std::vector<double>;

Block poseBlock(const core::Isometry& T) {
  Block block(kPoseSize);
  poseToBlock(T, block.data());
  return block;
}

Eigen::VectorXd residualAt(const ceres::CostFunction& factor, const std::vector<Block>& blocks) {
  std::vector<const double*> pointers;
  for (const auto& block : blocks) pointers.push_back(block.data());
  Eigen::VectorXd residual(factor.num_residuals());
  EXPECT_TRUE(factor.Evaluate(pointers.data(), residual.data(), nullptr));
  return residual;
}

/// Moves a block along a tangent direction: poses by the manifold, the rest by addition.
Block moved(const Block& block, int direction, double step) {
  Block result = block;
  if (block.size() != kPoseSize) {
    result[static_cast<std::size_t>(direction)] += step;
    return result;
  }
  core::Vector6 d = core::Vector6::Zero();
  d[direction] = step;
  Se3Manifold().Plus(block.data(), d.data(), result.data());
  return result;
}

/// Compares every analytic Jacobian of a factor with central differences.
void expectJacobiansMatch(const ceres::CostFunction& factor, const std::vector<Block>& blocks) {
  const int rows = factor.num_residuals();
  std::vector<const double*> pointers;
  std::vector<std::vector<double>> jacobians;
  std::vector<double*> jacobianPointers;
  for (const auto& block : blocks) {
    pointers.push_back(block.data());
    jacobians.emplace_back(static_cast<std::size_t>(rows) * block.size(), std::nan(""));
  }
  for (auto& jacobian : jacobians) jacobianPointers.push_back(jacobian.data());
  Eigen::VectorXd residual(rows);
  ASSERT_TRUE(factor.Evaluate(pointers.data(), residual.data(), jacobianPointers.data()));

  const double step = 1e-6;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const int columns = static_cast<int>(blocks[b].size());
    const int tangent = columns == kPoseSize ? 6 : columns;
    for (int c = 0; c < tangent; ++c) {
      std::vector<Block> ahead = blocks, behind = blocks;
      ahead[b] = moved(blocks[b], c, step);
      behind[b] = moved(blocks[b], c, -step);
      const Eigen::VectorXd numeric = (residualAt(factor, ahead) - residualAt(factor, behind)) / (2 * step);
      for (int r = 0; r < rows; ++r) {
        const double analytic = jacobians[b].data()[r * columns + c];
        // Central differences of functions of size 1e3 at most: truncation 1e-9, rounding 1e-16 * 1e3 / 1e-6.
        EXPECT_NEAR(analytic, numeric[r], 1e-6 * std::max(1.0, numeric.cwiseAbs().maxCoeff()))
            << "block " << b << " row " << r << " column " << c;
      }
    }
  }
}

}  // namespace

TEST(Se3Manifold, PlusThenMinus_GivesTheStep) {
  FixedRandom random(1);
  const Block x = poseBlock(random.pose(10, 1));
  const core::Vector6 step = random.normal6(1, 0.5);
  Block y(kPoseSize);
  Se3Manifold().Plus(x.data(), step.data(), y.data());
  core::Vector6 back;
  Se3Manifold().Minus(y.data(), x.data(), back.data());
  EXPECT_LT((back - step).norm(), 1e-12);  // rounding
}

TEST(Se3Manifold, Plus_IsTheBodyPerturbation) {
  FixedRandom random(2);
  const core::Isometry T = random.pose(10, 1);
  const core::Vector6 step = random.normal6(1, 0.5);
  Block y(kPoseSize);
  Se3Manifold().Plus(poseBlock(T).data(), step.data(), y.data());
  EXPECT_TRUE(poseFromBlock(y.data()).isApprox(perturbed(T, step), 1e-12));
}

TEST(BetweenFactor, Jacobians_MatchNumericOnes) {
  FixedRandom random(3);
  for (int trial = 0; trial < 20; ++trial) {
    const core::Isometry T_a = random.pose(20, 1), T_b = random.pose(20, 1);
    // From tiny residuals to large ones.
    const core::Isometry measured = perturbed(T_a.inverse() * T_b, random.normal6(0.01 + trial, 0.01 + 0.05 * trial));
    core::Matrix6 root = core::Matrix6::Identity();
    for (int r = 0; r < 6; ++r)
      for (int c = 0; c < 6; ++c) root(r, c) += 0.3 * random.normal();
    expectJacobiansMatch(BetweenFactor(measured, root * root.transpose()), {poseBlock(T_a), poseBlock(T_b)});
  }
}

TEST(BetweenFactor, ExactMeasurement_HasNoResidual) {
  FixedRandom random(4);
  const core::Isometry T_a = random.pose(20, 1), T_b = random.pose(20, 1);
  const BetweenFactor factor(T_a.inverse() * T_b, core::Matrix6::Identity());
  EXPECT_LT(residualAt(factor, {poseBlock(T_a), poseBlock(T_b)}).norm(), 1e-13);  // rounding of 20 m coordinates
}

TEST(BetweenFactor, SmallPerturbation_CostsItsMahalanobisDistance) {
  FixedRandom random(5);
  const core::Isometry T_a = random.pose(20, 1), T_a_b = random.pose(5, 1);
  const core::Matrix6 covariance = diagonalCovariance(0.1, 0.02);
  const core::Vector6 d = random.normal6(1e-3, 1e-3);
  const BetweenFactor factor(T_a_b, covariance.inverse());
  const Eigen::VectorXd residual = residualAt(factor, {poseBlock(T_a), poseBlock(T_a * perturbed(T_a_b, d))});
  const double expected = d.dot(covariance.inverse() * d);
  EXPECT_NEAR(residual.squaredNorm(), expected, 1e-5 * expected);  // third order in 1e-3 rad
}

TEST(BetweenFactor, SingularInformation_LeavesThatDirectionFree) {
  core::Matrix6 information = core::Matrix6::Identity();
  information(1, 1) = 0;
  const BetweenFactor factor(core::Isometry::Identity(), information);
  core::Isometry T_b = core::Isometry::Identity();
  T_b.translation().y() = 7;
  EXPECT_EQ(residualAt(factor, {poseBlock(core::Isometry::Identity()), poseBlock(T_b)}).norm(), 0);
}

TEST(SquareRootOfInformation, Squared_IsTheInformation) {
  FixedRandom random(6);
  core::Matrix6 A;
  for (double& value : A.reshaped()) value = random.normal();
  core::Matrix6 information = A * A.transpose();
  const core::Matrix6 S = squareRootOfInformation(information);
  EXPECT_TRUE((S.transpose() * S).isApprox(information, 1e-12));
  information.row(2).setZero();
  information.col(2).setZero();
  const core::Matrix6 singular = squareRootOfInformation(information);
  EXPECT_TRUE((singular.transpose() * singular).isApprox(information, 1e-12));
}

TEST(GravityFactor, Jacobians_MatchNumericOnes) {
  FixedRandom random(7);
  for (int trial = 0; trial < 10; ++trial)
    expectJacobiansMatch(GravityFactor(random.normal3(1), 0.1), {poseBlock(random.pose(20, 1))});
}

TEST(GravityFactor, Tilt_CostsItsAngleInSigmasAndHeadingNothing) {
  const core::Isometry T = core::isometryFromXyzYpr(1, 2, 3, 2.1, 0, 0.01);
  const GravityFactor factor(Eigen::Vector3d::UnitZ(), 0.005);
  // A roll of 0.01 rad at sigma 0.005 rad is two sigmas, to third order in the angle.
  EXPECT_NEAR(residualAt(factor, {poseBlock(T)}).norm(), 2.0, 1e-4);
}

TEST(WaterlineFactor, Jacobians_MatchNumericOnes) {
  FixedRandom random(8);
  expectJacobiansMatch(WaterlineFactor(0.3, 0.1), {poseBlock(random.pose(20, 1)), {0.7}});
  expectJacobiansMatch(WaterlineDriftFactor(0.2), {{0.7}, {0.9}});
}

TEST(GnssFactor, Jacobians_MatchNumericOnes) {
  FixedRandom random(9);
  for (int trial = 0; trial < 10; ++trial)
    expectJacobiansMatch(GnssFactor(random.normal3(30), random.normal3(2), Eigen::Vector3d(1, 2, 3)),
                         {poseBlock(random.pose(20, 1)), {3, -4, 5, 0.8 * trial}});
}
