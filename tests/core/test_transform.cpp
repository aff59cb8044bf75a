#include "s2s/core/transform.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace s2s;
using core::Isometry;

namespace {

class Transform : public testing::Test {
 protected:
  double uniform(double low, double high) { return low + (high - low) * static_cast<double>(random_()) / 4294967295.0; }
  Eigen::Vector3d vector(double size) { return {uniform(-size, size), uniform(-size, size), uniform(-size, size)}; }
  Isometry pose() {
    return core::isometryFromXyzYpr(uniform(-9, 9), uniform(-9, 9), uniform(-9, 9), uniform(-3.1, 3.1),
                                    uniform(-1.4, 1.4), uniform(-3.1, 3.1));
  }

 private:
  std::mt19937 random_{7};
};

}  // namespace

TEST_F(Transform, XyzYpr_EqualsMrptPose) {
  for (int i = 0; i < 100; ++i) {
    const double x = uniform(-9, 9), y = uniform(-9, 9), z = uniform(-9, 9);
    const double yaw = uniform(-3, 3), pitch = uniform(-1.5, 1.5), roll = uniform(-3, 3);
    const mrpt::poses::CPose3D pose(x, y, z, yaw, pitch, roll);
    EXPECT_TRUE(core::isometryFromXyzYpr(x, y, z, yaw, pitch, roll).isApprox(core::toIsometry(pose), 1e-14));
  }
}

TEST_F(Transform, PoseRoundTrip_IsExactToRounding) {
  for (int i = 0; i < 100; ++i) {
    const Isometry T = pose();
    EXPECT_TRUE(core::toIsometry(core::toPose(T)).isApprox(T, 1e-14));
  }
}

TEST_F(Transform, ExpSo3_EqualsAxisAngle) {
  for (const double angle : {0.0, 1e-9, 1e-7, 1e-5, 0.1, 1.0, 3.0}) {
    const Eigen::Vector3d axis = Eigen::Vector3d(1, -2, 0.5).normalized();
    const Eigen::Matrix3d expected = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    EXPECT_LT((core::expSo3(angle * axis) - expected).norm(), 1e-14) << angle;
  }
}

TEST_F(Transform, LogSo3_InvertsExpUpToPi) {
  for (const double angle : {0.0, 1e-12, 1e-9, 1e-6, 0.1, 1.0, 3.0, M_PI - 1e-6}) {
    const Eigen::Vector3d w = angle * Eigen::Vector3d(0.3, 2, -1).normalized();
    EXPECT_LT((core::logSo3(core::expSo3(w)) - w).norm(), 1e-9) << angle;
  }
}

TEST_F(Transform, LogSo3BeyondPi_TakesTheShorterWay) {
  const Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  EXPECT_LT((core::logSo3(core::expSo3(4.0 * axis)) - (4.0 - 2 * M_PI) * axis).norm(), 1e-12);
}

TEST_F(Transform, RightJacobian_EqualsNumericOne) {
  for (const double size : {1e-6, 1e-4, 1e-2, 1.0, 2.5}) {
    const Eigen::Vector3d w = size * Eigen::Vector3d(0.5, -0.7, 0.4);
    const double h = 1e-6;
    Eigen::Matrix3d numeric;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d d = h * Eigen::Vector3d::Unit(i);
      const Eigen::Matrix3d R = core::expSo3(w);
      numeric.col(i) =
          (core::logSo3(R.transpose() * core::expSo3(w + d)) - core::logSo3(R.transpose() * core::expSo3(w - d))) /
          (2 * h);
    }
    // Central differences with h = 1e-6 are good to about eps / h = 2e-10.
    EXPECT_LT((core::rightJacobianSo3(w) - numeric).norm(), 2e-9) << size;
  }
}

TEST_F(Transform, Interpolate_HitsEndsAndHalvesTheTurn) {
  for (int i = 0; i < 50; ++i) {
    const Isometry T0 = pose(), T1 = pose();
    EXPECT_TRUE(core::interpolate(T0, T1, 0).isApprox(T0, 1e-12));
    EXPECT_TRUE(core::interpolate(T0, T1, 1).isApprox(T1, 1e-9));
    const Isometry middle = core::interpolate(T0, T1, 0.5);
    EXPECT_NEAR(core::angleBetween(T0.linear(), middle.linear()), core::angleBetween(middle.linear(), T1.linear()),
                1e-9);
    EXPECT_TRUE(middle.translation().isApprox(0.5 * (T0.translation() + T1.translation()), 1e-12));
  }
}
