#include <gtest/gtest.h>

#include "s2s/odometry/registration.h"
#include "synthetic.h"

namespace s2s::odometry {
namespace {

using namespace synthetic;
using Eigen::Vector3d;

Path standingAt(const core::Isometry& T) {
  return [T](double) { return T; };
}

/// Points of a sweep from a standing sensor, in the vehicle's frame.
BodyPoints pointsFrom(const World& world, const core::Isometry& T, std::uint64_t seed, double sigma_m = 0.01) {
  Random random(seed);
  Lidar lidar;
  lidar.rangeSigma_m = sigma_m;
  const Scan scan = scanAt(world, standingAt(T), 0, lidar, random);
  BodyPoints body;
  for (const auto& p : scan.points_sensor) {
    body.points_body.emplace_back(scan.T_vehicle_sensor * p.cast<double>());
    body.variance_m2.push_back(sigma_m * sigma_m);
  }
  return body;
}

/// A map made of many sweeps around the world's middle, with true poses.
PlaneMap mapOf(const World& world) {
  PlaneMap map{PlaneMapOptions()};
  for (int i = 0; i < 12; ++i) {
    const core::Isometry T =
        core::isometryFromXyzYpr(0.3 * std::sin(2.1 * i), 0.3 * std::sin(1.3 * i), 0.8 + 0.1 * std::sin(3.7 * i),
                                 0.5 * i, 0.1 * std::sin(i), 0.1 * std::cos(i));
    std::vector<Vector3d> points;
    for (const auto& p : pointsFrom(world, T, 50 + i).points_body) points.emplace_back(T * p);
    map.insert(points);
  }
  return map;
}

PoseBelief beliefAt(const core::Isometry& T, double sigma_m, double sigma_rad) {
  PoseBelief belief;
  belief.T_map_body = T;
  belief.covariance.setIdentity();
  belief.covariance.topLeftCorner<3, 3>() *= sigma_m * sigma_m;
  belief.covariance.bottomRightCorner<3, 3>() *= sigma_rad * sigma_rad;
  return belief;
}

TEST(Registration, SeveralStartingErrors_AllFindTheTruePose) {
  const World world = room();
  const PlaneMap map = mapOf(world);
  const core::Isometry truth = core::isometryFromXyzYpr(0.2, -0.1, 0.85, 0.3, 0.05, -0.04);
  const BodyPoints points = pointsFrom(world, truth, 7);
  for (const Vector3d& shift :
       {Vector3d(0.3, 0, 0), Vector3d(0, -0.3, 0), Vector3d(0, 0, 0.25), Vector3d(0.2, 0.2, -0.1)})
    for (const Vector3d& turn :
         {Vector3d(0, 0, 0.06), Vector3d(0.04, 0, 0), Vector3d(0, -0.04, 0), Vector3d(0, 0, 0)}) {
      core::Isometry start = truth;
      start.translation() += shift;
      start.linear() = start.linear() * core::expSo3(turn);
      const auto result = registerPoints(points, map, beliefAt(start, 0.3, 0.05), start, {});
      EXPECT_NE(result.end, RegistrationEnd::tooFewMatches);
      // Thousands of points of 1 cm leave well below a millimetre; the planes' own errors some more.
      EXPECT_LT((result.pose.T_map_body.translation() - truth.translation()).norm(), 0.004) << shift.transpose();
      EXPECT_LT(core::angleBetween(result.pose.T_map_body.linear(), truth.linear()), 0.0005) << turn.transpose();
    }
}

TEST(Registration, Jacobian_MatchesNumericDifferences) {
  // One patch in the middle of each huge voxel, so that no point changes its plane between the poses compared.
  PlaneMapOptions mapOptions;
  mapOptions.voxel_m = 40;
  mapOptions.levels = 1;
  PlaneMap map(mapOptions);
  Random random(2);
  BodyPoints points;
  const core::Isometry T = core::isometryFromXyzYpr(3, -2, 1, 0.4, 0.2, -0.3);
  for (int patch = 0; patch < 6; ++patch) {
    const int row = patch / 3, column = patch % 3;
    const Vector3d centre(20 + 40 * column, 20 + 40 * row, 20);
    const Vector3d normal = random.gaussian3(1).normalized();
    const Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
    std::vector<Vector3d> surface;
    for (int i = 0; i < 60; ++i)
      surface.emplace_back(centre + (24 * random.uniform() - 12) * u + (24 * random.uniform() - 12) * v);
    map.insert(surface);
    for (int i = 0; i < 20; ++i) {
      points.points_body.emplace_back(T.inverse() * surface[i]);
      points.variance_m2.push_back(1.0);
    }
  }
  RegistrationOptions options;
  options.correlation = 1;
  const core::Matrix6 wide = core::Matrix6::Identity();
  const auto at = [&](const core::Vector6& d) {
    core::Isometry moved = T;
    moved.translation() += d.head<3>();
    moved.linear() = moved.linear() * core::expSo3(d.tail<3>());
    return linearise(points, map, moved, wide, 0.0, options);
  };
  const auto centre = at(core::Vector6::Zero());
  ASSERT_EQ(centre.matches, points.points_body.size());
  constexpr double h = 1e-4;
  for (int i = 0; i < 6; ++i) {
    core::Vector6 d = core::Vector6::Zero();
    d[i] = h;
    // b = sum w h r, so its derivative is A where the residuals vanish; the kernel's change is of second order.
    const core::Vector6 numeric = (at(d).b - at(-d).b) / (2 * h);
    EXPECT_LT((numeric - centre.A.col(i)).norm(), 1e-4 * centre.A.col(i).norm()) << "column " << i;
  }
}

TEST(Registration, FewPoints_ReturnThePrior) {
  const PlaneMap map = mapOf(room());
  BodyPoints points;
  points.points_body.assign(10, Vector3d(3, 0, 0));
  points.variance_m2.assign(10, 1e-4);
  const auto prior = beliefAt(core::isometryFromXyzYpr(0, 0, 0.8, 0, 0, 0), 0.1, 0.1);
  const auto result = registerPoints(points, map, prior, prior.T_map_body, {});
  EXPECT_EQ(result.end, RegistrationEnd::tooFewMatches);
  EXPECT_EQ(result.pose.T_map_body.matrix(), prior.T_map_body.matrix());
}

TEST(Registration, Corridor_KeepsThePriorAlongIt) {
  const World world = corridor();
  const PlaneMap map = mapOf(world);
  const core::Isometry truth = core::isometryFromXyzYpr(0.1, -0.1, 0.8, 0.1, 0.02, 0);
  core::Isometry start = truth;
  start.translation() += Vector3d(0.1, 0.05, -0.05);
  const auto result = registerPoints(pointsFrom(world, truth, 3), map, beliefAt(start, 0.2, 0.02), start, {});
  ASSERT_EQ(result.degenerateMotions.size(), 1U);
  const Vector3d direction = result.degenerateMotions.front().head<3>().normalized();
  EXPECT_GT(std::abs(direction.x()), 0.999);
  const Vector3d error = result.pose.T_map_body.translation() - truth.translation();
  // Across and up the walls and the floor tell; along x the prior stays, with its own uncertainty.
  EXPECT_LT(std::hypot(error.y(), error.z()), 0.004);
  EXPECT_NEAR(error.x(), 0.1, 0.01);
  EXPECT_NEAR(std::sqrt(result.pose.covariance(0, 0)), 0.2, 0.02);
}

TEST(Registration, Room_HasNoDegenerateDirection) {
  const World world = room();
  const PlaneMap map = mapOf(world);
  const core::Isometry truth = core::isometryFromXyzYpr(0.2, -0.1, 0.85, 0.3, 0.05, -0.04);
  const auto result = registerPoints(pointsFrom(world, truth, 7), map, beliefAt(truth, 0.1, 0.02), truth, {});
  EXPECT_TRUE(result.degenerateMotions.empty());
}

TEST(Registration, ThirdOfPointsMoved_PoseHolds) {
  const World world = room();
  const PlaneMap map = mapOf(world);
  const core::Isometry truth = core::isometryFromXyzYpr(0.2, -0.1, 0.85, 0.3, 0.05, -0.04);
  BodyPoints points = pointsFrom(world, truth, 7);
  // A boat that passes: a third of the view is 0.4 m nearer than the map says.
  for (std::size_t i = 0; i < points.points_body.size(); i += 3)
    points.points_body[i] -= 0.4 * points.points_body[i].normalized();
  const auto result = registerPoints(points, map, beliefAt(truth, 0.1, 0.02), truth, {});
  // The kernel leaves each outlier a small pull, and all pull the same way.
  EXPECT_LT((result.pose.T_map_body.translation() - truth.translation()).norm(), 0.01);
}

TEST(RemovePretended, NoiseOfNormals_LeavesNothingWhereNoSurfaceFaces) {
  // All normals along y and z, tilted about at random by the noise that the planes state.
  Random random(4);
  NormalEquations equations;
  const double tilt = 0.02;
  for (int i = 0; i < 3000; ++i) {
    const Vector3d n0 = i % 2 ? Vector3d::UnitY() : Vector3d::UnitZ();
    const Vector3d p(20 * random.uniform() - 10, 20 * random.uniform() - 10, 4 * random.uniform());
    const Vector3d n = (n0 + random.gaussian3(tilt)).normalized();
    core::Vector6 h;
    h << n, p.cross(n);
    equations.A += h * h.transpose();
    const Eigen::Matrix3d C = tilt * tilt * (Eigen::Matrix3d::Identity() - n * n.transpose());
    Eigen::Matrix<double, 6, 3> G;
    G << Eigen::Matrix3d::Identity(), core::skew(p);
    equations.pretended += G * C * G.transpose();
  }
  equations.meanLever2_m2 = 70;
  const double claimed = equations.A(0, 0);
  EXPECT_GT(claimed, 1.0);  // without care the scan claims to see x
  const auto unseen = removePretended(equations, 3.0);
  ASSERT_EQ(unseen.size(), 1U);
  EXPECT_GT(std::abs(unseen.front().head<3>().normalized().x()), 0.999);
  EXPECT_LT(equations.A(0, 0), 0.01 * claimed);
  EXPECT_GT(equations.A(1, 1), 1000);
}

/// Equations of 100 points 10 m around, all seeing along one direction with unit weight, and turns as a room would.
NormalEquations seeingAlong(const std::vector<Vector3d>& normals) {
  NormalEquations equations;
  for (const auto& n : normals) equations.A.topLeftCorner<3, 3>() += 100 * n * n.transpose();
  equations.A.bottomRightCorner<3, 3>() = 1e4 * Eigen::Matrix3d::Identity();
  equations.meanLever2_m2 = 100;
  return equations;
}

core::Vector6 motionAlong(const Vector3d& direction) {
  core::Vector6 motion = core::Vector6::Zero();
  motion.head<3>() = direction;
  return motion;
}

TEST(RemoveShared, BothBlindForTheSameMotion_NothingIsLeftOfIt) {
  // A floor, off level by 50 mm/m, and a wall: blind along x up to that.
  const Vector3d floor = Vector3d(-0.05, 0, 1).normalized(), blind = Vector3d(1, 0, 0.05).normalized();
  NormalEquations equations = seeingAlong({floor, Vector3d::UnitY()});
  const core::Matrix6 before = equations.A;
  removeShared({motionAlong(blind)}, {motionAlong(Vector3d::UnitX())}, equations);
  EXPECT_GT(before(0, 0), 0.2);                // what the slope pretended to know of x
  EXPECT_LT(equations.A.row(0).norm(), 1e-9);  // exact but for rounding
  // The rest stays: z but for the square of the slope, y and the turns wholly.
  EXPECT_NEAR(equations.A(2, 2), 100, 0.3);
  EXPECT_NEAR(equations.A(1, 1), before(1, 1), 1e-9);
  EXPECT_TRUE(equations.A.bottomRightCorner(3, 3).isApprox(before.bottomRightCorner(3, 3)));
}

TEST(RemoveShared, BlindForDifferentMotions_NothingChanges) {
  NormalEquations equations = seeingAlong({Vector3d::UnitZ(), Vector3d::UnitY()});
  const core::Matrix6 before = equations.A;
  removeShared({motionAlong(Vector3d::UnitX())}, {motionAlong(Vector3d::UnitY())}, equations);
  EXPECT_TRUE(equations.A.isApprox(before));
  removeShared({motionAlong(Vector3d::UnitX())}, {}, equations);
  removeShared({}, {motionAlong(Vector3d::UnitX())}, equations);
  EXPECT_TRUE(equations.A.isApprox(before));
}

}  // namespace
}  // namespace s2s::odometry
