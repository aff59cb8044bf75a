#include <gtest/gtest.h>

#include "s2s/graph/cloud_registration.h"
#include "synthetic_survey.h"

using namespace s2s;
using namespace s2s::graph;
using graph::test::difference;
using graph::test::FixedRandom;
using graph::test::SyntheticTown;

namespace {

/// Two parallel walls along x, 20 m apart: nothing tells x.
Cloud straightCanal(FixedRandom& random) {
  Cloud cloud;
  for (int n = 0; n < 6000; ++n)
    cloud.emplace_back(static_cast<float>(random.uniform(-40, 40)),
                       static_cast<float>((n % 2 ? 10 : -10) + random.normal(0.01)),
                       static_cast<float>(random.uniform(0, 5)));
  return cloud;
}

}  // namespace

TEST(CloudRegistration, TownSeenTwice_GivesTheMotionBetween) {
  const SyntheticTown town(120, 60, 61);
  FixedRandom random(62);
  const RegistrationOptions options;
  for (int trial = 0; trial < 5; ++trial) {
    const core::Isometry T_map_a = core::isometryFromXyzYpr(20 + 10 * trial, 0, 0, 0.3 * trial, 0, 0);
    const core::Isometry T_a_b = core::isometryFromXyzYpr(1.5, -1, 0.1, 0.2, 0.02, -0.01);
    const RegistrationTarget target(town.scan(T_map_a, 40, random), options);
    const Cloud source = voxelDownsampleTo(town.scan(T_map_a * T_a_b, 40, random), 0.4, 4000);
    const RegistrationResult result = registerCloud(target, source, T_a_b * random.pose(0.5, 0.02), options);
    ASSERT_EQ(result.status, RegistrationStatus::converged) << trial;
    const core::Vector6 error = difference(T_a_b, result.T_target_source);
    // Points with 1 cm of noise, thousands of them; the means of voxels cut by edges leave some millimetres.
    EXPECT_LT(error.head<3>().norm(), 0.01) << trial;
    EXPECT_LT(error.tail<3>().norm(), 0.0005) << trial;
    // The stated covariance must not be smaller than the error: 6 degrees of freedom, 99.9 %.
    EXPECT_LT(error.dot(result.covariance.inverse() * error), 22.5) << trial;
  }
}

TEST(CloudRegistration, StartTwoMetresOff_StillConverges) {
  const SyntheticTown town(120, 60, 61);
  FixedRandom random(63);
  const RegistrationOptions options;
  const core::Isometry T_map_a = core::isometryFromXyzYpr(40, 0, 0, 0, 0, 0);
  const RegistrationTarget target(town.scan(T_map_a, 40, random), options);
  const Cloud source = voxelDownsampleTo(town.scan(T_map_a, 40, random), 0.4, 4000);
  for (const Eigen::Vector3d& start :
       {Eigen::Vector3d(2, 0, 0), Eigen::Vector3d(0, -2, 0), Eigen::Vector3d(1.4, 1.4, 0)}) {
    core::Isometry T = core::isometryFromXyzYpr(start.x(), start.y(), start.z(), 0.05, 0, 0);
    const RegistrationResult result = registerCloud(target, source, T, options);
    EXPECT_EQ(result.status, RegistrationStatus::converged);
    EXPECT_LT(result.T_target_source.translation().norm(), 0.01);  // as above
  }
}

TEST(CloudRegistration, StraightCanal_LeavesTheWayAlongItUnknown) {
  FixedRandom random(64);
  const RegistrationOptions options;
  const RegistrationTarget target(straightCanal(random), options);
  const core::Isometry T_start = core::isometryFromXyzYpr(0.7, 0.3, 0, 0.02, 0, 0);
  const RegistrationResult result = registerCloud(target, straightCanal(random), T_start, options);
  EXPECT_EQ(result.status, RegistrationStatus::converged);
  EXPECT_GE(result.degenerate, 2);  // along the canal and up
  EXPECT_GT(std::sqrt(result.covariance(0, 0)), 3);
  EXPECT_NEAR(result.T_target_source.translation().x(), 0.7, 0.02);  // kept, not invented
  EXPECT_NEAR(result.T_target_source.translation().y(), 0, 0.01);
  EXPECT_LT(std::sqrt(result.covariance(1, 1)), 0.05);
}

TEST(CloudRegistration, SingleWall_IsCalledDegenerate) {
  FixedRandom random(66);
  Cloud wall;
  for (const auto& point : straightCanal(random))
    if (point.y() > 0) wall.push_back(point);
  RegistrationOptions options;
  options.maxDegenerate = 2;
  const RegistrationTarget target(wall, options);
  EXPECT_EQ(registerCloud(target, wall, core::Isometry::Identity(), options).status, RegistrationStatus::degenerate);
}

TEST(CloudRegistration, OtherPlace_IsRefused) {
  FixedRandom random(65);
  const RegistrationOptions options;
  const SyntheticTown here(120, 60, 61), there(120, 60, 99);
  const core::Isometry T = core::isometryFromXyzYpr(40, 0, 0, 0, 0, 0);
  const RegistrationTarget target(here.scan(T, 40, random), options);
  const RegistrationResult result = registerCloud(target, voxelDownsampleTo(there.scan(T, 40, random), 0.4, 4000),
                                                  core::Isometry::Identity(), options);
  EXPECT_NE(result.status, RegistrationStatus::converged);
}

TEST(CloudRegistration, EmptyClouds_AreRefusedWithoutAPose) {
  const RegistrationOptions options;
  const RegistrationTarget empty({}, options);
  EXPECT_EQ(registerCloud(empty, {{1, 2, 3}}, core::Isometry::Identity(), options).status,
            RegistrationStatus::tooFewPartners);
  const RegistrationTarget target({{1, 2, 3}}, options);
  EXPECT_EQ(registerCloud(target, {}, core::Isometry::Identity(), options).status, RegistrationStatus::tooFewPartners);
}
