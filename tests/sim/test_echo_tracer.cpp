#include <gtest/gtest.h>

#include "sim_support.h"

using namespace s2s;
using namespace s2s::test;
using core::isometryFromXyzYpr;
using Eigen::Vector3d;

namespace {

constexpr double kDegree = M_PI / 180;

double totalPower(const sim::EchoImage& image) {
  double sum = 0;
  for (const float p : image.power) sum += p;
  return sum;
}

double binOf(const sim::SonarOptions& o, double range_m) { return range_m * o.rangeCount / o.maxRange_m; }

}  // namespace

TEST(EchoTracer, FlatSeabed_FirstAndLastReturnLieAtTheAperturesEdges) {
  const sim::SonarOptions o = idealSonar();
  for (const double height : {2.0, 3.0, 4.0}) {
    const sim::Scene scene = sceneOf({makeFloor(-0.5 - height, 40)});
    const auto image = traceEcho(o, scene, isometryFromXyzYpr(0, 0, -0.5, 0, 45 * kDegree, 0));
    const auto bins = extent(image, 256);
    EXPECT_NEAR(bins.first, binOf(o, height / std::sin(55 * kDegree)), 2);  // the promise: two range bins
    EXPECT_NEAR(bins.second, binOf(o, height / std::sin(35 * kDegree)), 2);
  }
}

TEST(EchoTracer, FlatSeabed_FillsAllBinsInBetween) {
  const sim::SonarOptions o = idealSonar();
  const auto image = traceEcho(o, sceneOf({makeFloor(-3.5, 40)}), isometryFromXyzYpr(0, 0, -0.5, 0, 45 * kDegree, 0));
  for (const std::size_t beam : {std::size_t{60}, std::size_t{256}, std::size_t{400}}) {
    const auto bins = extent(image, beam);
    for (int bin = bins.first; bin <= bins.second; ++bin)
      EXPECT_GT(image.at(static_cast<std::size_t>(bin), beam), 0) << "beam " << beam << " bin " << bin;
  }
}

TEST(EchoTracer, FlatSeabed_PowerIsTheIntegralOfTheSonarEquation) {
  sim::SonarOptions o = idealSonar();
  o.absorption = true;
  o.maxRange_m = 12;
  const double height = 3, pitch = 45 * kDegree;
  const auto image = traceEcho(o, sceneOf({makeFloor(-0.5 - height, 60)}), isometryFromXyzYpr(0, 0, -0.5, 0, pitch, 0));
  const sim::SonarGeometry g(o);
  for (const std::size_t beam : {std::size_t{100}, std::size_t{256}, std::size_t{300}}) {
    // Power = SL mu int cos(i) / r^2 10^(-2 a r / 10) dOmega over the beam's cell, by the midpoint rule.
    double integral = 0;
    constexpr int kSteps = 20000;
    const double b = g.bearings_rad()[beam];
    for (int i = 0; i < kSteps; ++i) {
      const double e = (-10 + 20 * (i + 0.5) / kSteps) * kDegree;
      const double sine = std::sin(pitch) * std::cos(e) * std::cos(b) - std::cos(pitch) * std::sin(e);
      const double r = height / sine;  // on a flat bed cos(incidence) is the sine of the grazing angle
      if (r < o.maxRange_m) integral += sine / (r * r) * std::pow(10, -0.2 * o.absorption_dbPerM * r) * std::cos(e);
    }
    integral *= 20 * kDegree / kSteps * g.cellWidth_rad(beam) * std::pow(10, 0.1 * (o.sourceLevel_db - 20));
    double power = 0;
    for (std::size_t bin = 0; bin < image.rangeCount; ++bin) power += image.at(bin, beam);
    EXPECT_NEAR(power / integral, 1, 0.01);  // 64 stratified rays and a bearing drawn inside the cell
  }
}

TEST(EchoTracer, Sphere_AnswersAtItsNearestPoint_InTheBeamsItCovers) {
  const sim::SonarOptions o = idealSonar();
  const double distance = 5, radius = 0.4;
  const auto image = traceEcho(o, sceneOf({moved(sim::makeSphere(radius, 64), distance, 0, -20)}),
                               isometryFromXyzYpr(0, 0, -20, 0, 0, 0));
  EXPECT_NEAR(extent(image, 256).first, binOf(o, distance - radius), 2);
  const sim::SonarGeometry g(o);
  const double edge = std::asin(radius / distance);
  for (std::size_t beam = 0; beam < image.beamCount; ++beam) {
    const double b = std::abs(g.bearings_rad()[beam]);
    const bool answers = extent(image, beam).first >= 0;
    EXPECT_TRUE(answers || b > edge - 0.5 * kDegree) << beam;
    EXPECT_TRUE(!answers || b < edge + 0.5 * kDegree) << beam;
  }
}

TEST(EchoTracer, Wall_FirstReturnsLieOnItsPlane) {
  const sim::SonarOptions o = idealSonar();
  const double distance = 4;
  const auto wall = moved(makeFloor(0, 30), distance, 0, -40, 0, 90 * kDegree);  // stands across the x axis
  const auto image = traceEcho(o, sceneOf({wall}), isometryFromXyzYpr(0, 0, -40, 0, 0, 0));
  const sim::SonarGeometry g(o);
  for (std::size_t beam = 60; beam < 452; beam += 28) {
    const double r = distance / std::cos(g.bearings_rad()[beam]);
    // A beam's cell is up to 0.4 degrees wide, over which the range changes.
    const double slack = binOf(o, r * std::tan(std::abs(g.bearings_rad()[beam])) * g.cellWidth_rad(beam));
    EXPECT_NEAR(extent(image, beam).first, binOf(o, r), 2 + slack) << beam;
    EXPECT_NEAR(extent(image, beam).second, binOf(o, r / std::cos(10 * kDegree)), 2 + slack) << beam;
  }
}

TEST(EchoTracer, WedgeOfTwoWalls_MeetsAtTheCornersRange) {
  // Two vertical walls at +-45 degrees that meet at x = 6: beam 0 looks into the corner.
  const sim::SonarOptions o = idealSonar();
  sim::TriangleMesh corner;
  const auto post = [&](double x, double y) {
    return std::make_pair(corner.addVertex({x, y, -50}), corner.addVertex({x, y, -30}));
  };
  const auto left = post(1, 5), middle = post(6, 0), right = post(1, -5);
  corner.addQuad(left.first, middle.first, middle.second, left.second);
  corner.addQuad(middle.first, right.first, right.second, middle.second);
  const auto image = traceEcho(o, sceneOf({corner}), isometryFromXyzYpr(0, 0, -40, 0, 0, 0));
  const sim::SonarGeometry g(o);
  for (const std::size_t beam : {std::size_t{255}, std::size_t{340}, std::size_t{430}}) {
    const double b = std::abs(g.bearings_rad()[beam]);
    const double r = 6 / (std::cos(b) + std::sin(b));                // where the beam meets x + |y| = 6
    EXPECT_NEAR(extent(image, beam).first, binOf(o, r), 3) << beam;  // the bearing is drawn inside the cell
  }
}

TEST(EchoTracer, Shadow_EndsWhereTheRayOverTheObjectsTopMeetsTheSeabed) {
  sim::SonarOptions o = idealSonar();
  o.elevationRays = 2000;  // so that the shadow's edge is sharper than a range bin
  o.maxRange_m = 15;
  const double height = 3, x = 4, top = 0.8;
  const auto plate = moved(makeFloor(0, 0.5 * top), x, 0, -0.5 - height + 0.5 * top, 0, 90 * kDegree);
  const auto image =
      traceEcho(o, sceneOf({makeFloor(-0.5 - height, 60), plate}), isometryFromXyzYpr(0, 0, -0.5, 0, 30 * kDegree, 0));
  const double end = x * height / (height - top);  // horizontal distance at which the shadow ends
  const double shadowFirst = binOf(o, std::hypot(x, height)), shadowLast = binOf(o, std::hypot(end, height));
  for (double bin = std::ceil(shadowFirst) + 1; bin < shadowLast - 2; ++bin)
    EXPECT_EQ(image.at(static_cast<std::size_t>(bin), 256), 0) << bin;
  EXPECT_GT(image.at(static_cast<std::size_t>(shadowLast + 2), 256), 0);
}

TEST(EchoTracer, WrongSoundSpeed_ScalesTheRanges) {
  sim::SonarOptions o = idealSonar();
  o.soundSpeed_mps = 1450;
  o.soundSpeedAssumed_mps = 1500;
  const auto wall = moved(makeFloor(0, 30), 6, 0, -40, 0, 90 * kDegree);
  const auto image = traceEcho(o, sceneOf({wall}), isometryFromXyzYpr(0, 0, -40, 0, 0, 0));
  // Two-way time 2 * 6 / 1450 s, taken for range with 1500 m/s.
  EXPECT_NEAR(extent(image, 256).first, binOf(o, 6.0 * 1500 / 1450), 1);
}

TEST(EchoTracer, Absorption_TakesTwiceItsCoefficientPerMetre) {
  sim::SonarOptions o = idealSonar();
  const sim::Scene scene = sceneOf({makeFloor(-3.5, 40)});
  const auto pose = isometryFromXyzYpr(0, 0, -0.5, 0, 45 * kDegree, 0);
  const auto without = traceEcho(o, scene, pose);
  o.absorption = true;
  o.absorption_dbPerM = 1.6;
  const auto with = traceEcho(o, scene, pose);
  const auto bins = extent(without, 256);
  for (int bin = bins.first + 2; bin < bins.second - 2; bin += 5) {
    const auto i = static_cast<std::size_t>(bin);
    const double loss_db = -10 * std::log10(with.at(i, 256) / without.at(i, 256));
    const double r = (bin + 0.5) * o.maxRange_m / o.rangeCount;
    EXPECT_NEAR(loss_db, 2 * 1.6 * r, 0.2);  // a ray's power is spread over up to 3 bins, 0.14 dB
  }
}

TEST(EchoTracer, SmallTarget_LosesFortyLogRange) {
  sim::SonarOptions o = idealSonar();
  o.elevationRays = 800;
  const auto power = [&](double distance) {
    return totalPower(traceEcho(o, sceneOf({moved(sim::makeSphere(0.15, 48), distance, 0, -30)}),
                                isometryFromXyzYpr(0, 0, -30, 0, 0, 0)));
  };
  // A Lambertian sphere's echo comes, on average over its face, from 3/4 of its radius in front of its centre. Rays
  // meet the far sphere in ten beams only, which leaves a few per cent.
  const double near_m = 4 - 0.75 * 0.15, far_m = 8 - 0.75 * 0.15;
  EXPECT_NEAR(10 * std::log10(power(4) / power(8)), 40 * std::log10(far_m / near_m), 0.3);
}

TEST(EchoTracer, StrongestReturns_AreTruePointsOfTheImage) {
  const sim::SonarOptions o = idealSonar();
  std::vector<sim::StrongReturn> strongest;
  const auto pose = isometryFromXyzYpr(3, -2, -0.5, 1, 45 * kDegree, 0);
  traceEcho(o, sceneOf({makeFloor(-3.5, 40)}), pose, &strongest);
  const sim::SonarGeometry g(o);
  ASSERT_GT(strongest.size(), 400u);
  for (const auto& s : strongest) {
    const Vector3d p_sensor = pose.inverse() * Vector3d(s.x, s.y, s.z);
    EXPECT_NEAR(s.z, -3.5, 1e-4);
    EXPECT_NEAR(binOf(o, p_sensor.norm()), s.bin + 0.5, 1.5 + 1e-3);
    EXPECT_NEAR(g.bearingElevation(p_sensor.normalized()).x(), g.bearings_rad()[s.beam], 0.6 * g.cellWidth_rad(s.beam));
  }
}

TEST(EchoTracer, NothingInReach_NoPower) {
  std::vector<sim::StrongReturn> strongest;
  const auto image = traceEcho(idealSonar(), sceneOf({makeFloor(-60, 40)}),
                               isometryFromXyzYpr(0, 0, -0.5, 0, 45 * kDegree, 0), &strongest);
  EXPECT_EQ(totalPower(image), 0);
  EXPECT_TRUE(strongest.empty());
}
