#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "s2s/sonar/arc_intersection.h"
#include "s2s/sonar/ping_geometry.h"
#include "s2s/sonar/triangulation.h"

namespace s2s::sonar {
namespace {

using obs::BearingModel;

constexpr double kDeg = M_PI / 180.0;
constexpr double kAperture = 20 * kDeg;

/// The vertical sonar: rolled by 90 degrees, 0.05 ahead, 0.02 aside and 0.18 m above the horizontal one.
core::Isometry verticalPose() { return core::isometryFromXyzYpr(0.05, 0.02, 0.18, 0, 0, M_PI / 2); }

struct Setting {
  const char* name;
  core::Isometry T_h_v;
  BearingModel model_h, model_v;
};

std::vector<Setting> settings() {
  return {{"azimuth", verticalPose(), BearingModel::Azimuth, BearingModel::Azimuth},
          {"cone", verticalPose(), BearingModel::Cone, BearingModel::Cone},
          {"mixed", verticalPose(), BearingModel::Azimuth, BearingModel::Cone},
          {"skewed", core::isometryFromXyzYpr(-0.3, 0.4, 0.2, 6 * kDeg, -4 * kDeg, -70 * kDeg), BearingModel::Azimuth,
           BearingModel::Azimuth}};
}

/// A point seen by both, 2 to 10 m away, within 10 degrees of the axis.
Eigen::Vector3d randomPoint(std::mt19937& random) {
  std::uniform_real_distribution<double> range(2, 10), angle(-10 * kDeg, 10 * kDeg);
  return pointAt({range(random), angle(random), angle(random)}, BearingModel::Azimuth);
}

BeamMeasurement measure(const Eigen::Vector3d& p_sonar, BearingModel model, double rangeSigma_m,
                        double bearingSigma_rad) {
  const auto c = sonarCoordinates(p_sonar, model);
  return {c.range_m, c.bearing_rad, rangeSigma_m, bearingSigma_rad};
}

struct Pair {
  BeamMeasurement h, v;
};

Pair measureBoth(const Eigen::Vector3d& p_h, const Setting& s) {
  return {measure(p_h, s.model_h, 0.01, 0.15 * kDeg), measure(s.T_h_v.inverse() * p_h, s.model_v, 0.01, 0.12 * kDeg)};
}

void addNoise(BeamMeasurement& m, std::mt19937& random) {
  std::normal_distribution<double> normal;
  m.range_m += m.rangeSigma_m * normal(random);
  m.bearing_rad += m.bearingSigma_rad * normal(random);
}

Triangulator triangulatorFor(const Setting& s, Fusion fusion) {
  TriangulationOptions options;
  options.fusion = fusion;
  return {s.T_h_v, s.model_h, s.model_v, kAperture, kAperture, options};
}

TEST(Triangulation, NoNoise_GivesTheExactPoint) {
  std::mt19937 random(1);
  for (const Setting& s : settings())
    for (int i = 0; i < 500; ++i) {
      const Eigen::Vector3d p = randomPoint(random);
      const Pair m = measureBoth(p, s);
      const auto t = triangulatorFor(s, Fusion::Exact).fuse(m.h, m.v);
      ASSERT_TRUE(t.converged) << s.name;
      EXPECT_LT((t.p_h - p).norm(), 1e-6) << s.name;  // Gauss-Newton ends at steps of 1e-7 m
      EXPECT_LT(t.residual, 1e-4) << s.name;
    }
}

struct Errors {
  double mean = 0, percentile95 = 0, nees = 0;
  double meanResidual2 = 0;
};

Errors errorsOf(const Setting& s, Fusion fusion, int count) {
  std::mt19937 random(2);
  std::vector<double> errors;
  Errors e;
  const Triangulator triangulator = triangulatorFor(s, fusion);
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d p = randomPoint(random);
    Pair m = measureBoth(p, s);
    addNoise(m.h, random);
    addNoise(m.v, random);
    const auto t = triangulator.fuse(m.h, m.v);
    EXPECT_TRUE(t.converged);
    const Eigen::Vector3d d = t.p_h - p;
    errors.push_back(d.norm());
    e.mean += d.norm() / count;
    e.nees += d.dot(t.covariance.ldlt().solve(d)) / count;
    e.meanResidual2 += t.residual * t.residual / count;
  }
  std::sort(errors.begin(), errors.end());
  e.percentile95 = errors[static_cast<std::size_t>(0.95 * count)];
  return e;
}

TEST(Triangulation, PaperNoise_ExactIsWithinTwoCentimetres) {
  constexpr int kCount = 20000;
  for (const Setting& s : settings()) {
    const Errors average = errorsOf(s, Fusion::Average, kCount), coordinate = errorsOf(s, Fusion::Coordinate, kCount),
                 exact = errorsOf(s, Fusion::Exact, kCount);
    std::printf("%-8s mean (95%%) error: average %.3f (%.3f)  coordinate %.3f (%.3f)  exact %.4f (%.4f) m, NEES %.3f\n",
                s.name, average.mean, average.percentile95, coordinate.mean, coordinate.percentile95, exact.mean,
                exact.percentile95, exact.nees);
    // The figure the design promises for crossed planes; planes at a lesser angle tell the elevation less well, by the
    // sine of the angle between them.
    EXPECT_LE(exact.mean, 0.020 / s.T_h_v.linear().col(2).cross(Eigen::Vector3d::UnitZ()).norm()) << s.name;
    EXPECT_LT(exact.mean, coordinate.mean) << s.name;
    EXPECT_LT(coordinate.mean, average.mean) << s.name;
  }
}

TEST(Triangulation, PaperNoise_CovariancePassesNees) {
  constexpr int kCount = 20000;
  for (const Setting& s : settings()) {
    const Errors e = errorsOf(s, Fusion::Exact, kCount);
    // NEES of a 3D point is chi-squared with 3 degrees of freedom: mean 3, variance 6; the mean of 20,000 scatters by
    // 0.017. The bounds are four sigma plus 0.03 for the curvature that a first-order covariance leaves out.
    EXPECT_NEAR(e.nees, 3.0, 0.1) << s.name;
    // One degree of freedom is left: mean 1, variance 2, so 0.01 scatter.
    EXPECT_NEAR(e.meanResidual2, 1.0, 0.05) << s.name;
  }
}

TEST(Triangulation, AverageOfTheEquationReadLiterally_HalvesTheUnseenCoordinates) {
  const Setting s{"centered", core::isometryFromXyzYpr(0, 0, 0, 0, 0, M_PI / 2), BearingModel::Azimuth,
                  BearingModel::Azimuth};
  const Eigen::Vector3d p(5, 0.4, -0.3);
  const Pair m = measureBoth(p, s);
  const auto average = triangulatorFor(s, Fusion::Average).fuse(m.h, m.v);
  const auto coordinate = triangulatorFor(s, Fusion::Coordinate).fuse(m.h, m.v);
  // Projected onto its plane at full range, a point's in-plane coordinates grow by |p| / in-plane length.
  EXPECT_NEAR(coordinate.p_h.y(), 0.4 * p.norm() / std::hypot(5.0, 0.4), 1e-9);
  EXPECT_NEAR(coordinate.p_h.z(), -0.3 * p.norm() / std::hypot(5.0, 0.3), 1e-9);
  EXPECT_NEAR(average.p_h.y(), 0.5 * coordinate.p_h.y(), 1e-9);
  EXPECT_NEAR(average.p_h.z(), 0.5 * coordinate.p_h.z(), 1e-9);
}

TEST(Triangulation, ParallelImagingPlanes_AreRefused) {
  const Setting s{"parallel", core::isometryFromXyzYpr(0.2, 0, 0, 0, 0, 0), BearingModel::Azimuth,
                  BearingModel::Azimuth};
  const Pair m = measureBoth({5, 0.3, 0}, s);
  EXPECT_FALSE(triangulatorFor(s, Fusion::Exact).fuse(m.h, m.v).converged);
}

TEST(ArcIntersection, ExactMeasurements_MeetAtThePointWithoutMisfit) {
  std::mt19937 random(4);
  for (const Setting& s : settings())
    for (int i = 0; i < 300; ++i) {
      const Eigen::Vector3d p = randomPoint(random);
      const Pair m = measureBoth(p, s);
      const ArcIntersector intersector(s.T_h_v, 40 * kDeg, 60 * kDeg, 0);
      const auto point = intersector.intersect(arcOf(m.h.range_m, m.h.bearing_rad, s.model_h),
                                               planeOf(m.v.range_m, m.v.bearing_rad, s.model_v, s.T_h_v.inverse()));
      ASSERT_TRUE(point.has_value()) << s.name;
      EXPECT_LT((point->p_h - p).norm(), 1e-9) << s.name;
      EXPECT_NEAR(point->rangeMisfit_m, 0, 1e-9) << s.name;
      const auto [low, high] = intersector.rangesFromVertical(arcOf(m.h.range_m, m.h.bearing_rad, s.model_h));
      EXPECT_GE(m.v.range_m, low - 0.005) << s.name;  // bounded by three points of the arc, so to some millimetres
      EXPECT_LE(m.v.range_m, high + 0.005) << s.name;
    }
}

TEST(ArcIntersection, NoisyMeasurements_MisfitPredictsTheExactResidual) {
  std::mt19937 random(5);
  const Setting s = settings().front();
  const ArcIntersector intersector(s.T_h_v, 40 * kDeg, 40 * kDeg, 0);
  const Triangulator triangulator = triangulatorFor(s, Fusion::Exact);
  for (int i = 0; i < 300; ++i) {
    Pair m = measureBoth(randomPoint(random), s);
    addNoise(m.h, random);
    addNoise(m.v, random);
    const auto point = intersector.intersect(arcOf(m.h.range_m, m.h.bearing_rad, s.model_h),
                                             planeOf(m.v.range_m, m.v.bearing_rad, s.model_v, s.T_h_v.inverse()));
    ASSERT_TRUE(point.has_value());
    const double predicted = std::abs(point->rangeMisfit_m) / (0.01 * std::sqrt(2.0));
    // The lever arm of 0.19 m adds 0.5 mm to the misfit's 14 mm, and the rest is second order.
    EXPECT_NEAR(predicted, triangulator.fuse(m.h, m.v).residual, 0.03);
  }
}

TEST(ArcIntersection, OutsideTheApertures_GivesNothing) {
  const core::Isometry T = verticalPose();
  const ArcIntersector intersector(T, kAperture, kAperture, 0);
  // 15 degrees above the horizontal sonar's plane, whose aperture ends at 10.
  const auto plane = planeOf(5, 15 * kDeg, BearingModel::Azimuth, T.inverse());
  EXPECT_FALSE(intersector.intersect(arcOf(5, 0, BearingModel::Azimuth), plane).has_value());
}

}  // namespace
}  // namespace s2s::sonar
