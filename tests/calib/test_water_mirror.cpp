#include <gtest/gtest.h>

#include <random>

#include "s2s/calib/water_mirror.h"
#include "s2s/sonar/ping_geometry.h"

namespace s2s::calib {
namespace {

constexpr core::TimeNs kStart = 1'733'400'000'000'000'000;
constexpr double kWater_m = 0.2, kBed_m = -3.3;  // in the map

/// First echoes of a level bed and, `strength` times as strong, their images in the water.
struct Survey {
  SonarState sonar;
  core::Trajectory path;
  std::vector<MirrorTrace> traces;

  Survey(double strength, bool isDecaying) {
    sonar.T_vehicle_sonar = core::isometryFromXyzYpr(-1.1, -0.1, -0.6, 0, M_PI / 4, M_PI / 2);
    sonar.deviceSoundSpeed_mps = 1480;
    for (int k = -2; k < 60; ++k)
      path.append(kStart + core::durationNs(k * 0.1),
                  core::isometryFromXyzYpr(0.1 * k, 0, kWater_m + 0.05 * std::sin(0.7 * k), 0, 0.02, 0));
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0, 0.02);
    for (int k = 0; k < 58; ++k) {
      const core::Isometry T = *path.at(kStart + core::durationNs(k * 0.1)) * sonar.T_vehicle_sonar;
      for (double bearing = 0.05; bearing < 0.35; bearing += 0.01) {
        const Eigen::Vector3d ray = T.linear() * sonar::pointAt({1, bearing, 0}, sonar.model);
        const double range = (kBed_m - T.translation().z()) / ray.z();
        const Eigen::Vector3d p = T * sonar::pointAt({range, bearing, 0}, sonar.model);
        const Eigen::Vector3d image(p.x(), p.y(), 2 * kWater_m - p.z());
        const double gap = 0.5 * ((image - T.translation()).norm() - range);
        MirrorTrace trace{
            kStart + core::durationNs(k * 0.1), static_cast<float>(bearing), static_cast<float>(range), {}};
        for (int j = 0; j < 160; ++j) {
          const double u = 0.01 * (j - 30);
          trace.strength.push_back(
              static_cast<float>(shape(u, isDecaying) + strength * shape(u - gap, isDecaying) + noise(random)));
        }
        traces.push_back(std::move(trace));
      }
    }
  }

  /// An echo, as sharp at its beginning as a pulse of 2 cm makes it, or blurred.
  static double shape(double u, bool isDecaying) {
    if (isDecaying) return std::exp(-u / 0.08) / (1 + std::exp(-(u - 0.02) / 0.005));
    return std::exp(-0.5 * std::pow((u - 0.03) / 0.05, 2));
  }
};

class WaterMirror : public ::testing::TestWithParam<bool> {};

TEST_P(WaterMirror, SonarThoughtTooHigh_IsFoundWhereItIs) {
  const Survey survey(0.2, GetParam());
  for (const double wrong_m : {0.07, 0.0, -0.05}) {
    SonarState sonar = survey.sonar;
    sonar.correction[kZ] = wrong_m;
    const auto found = mirrorDepth(survey.traces, sonar, 1480, survey.path, kWater_m, {});
    ASSERT_TRUE(found);
    // Gaps are sorted into bins of a centimetre and change by 0.6 of the height: half a bin is 8 mm, and most of it
    // evens out over the gaps.
    EXPECT_NEAR(found->higher_m, -wrong_m, 0.005) << wrong_m;
    EXPECT_NEAR(found->strength, 0.2, 0.06);  // looked for in steps of 0.05
  }
}

TEST_P(WaterMirror, RoughSurface_TellsNothing) {
  const Survey survey(0, GetParam());
  EXPECT_FALSE(mirrorDepth(survey.traces, survey.sonar, 1480, survey.path, kWater_m, {}));
}

INSTANTIATE_TEST_SUITE_P(Shapes, WaterMirror, ::testing::Bool());

TEST(WaterMirrorData, TooFewTraces_TellNothing) {
  Survey survey(0.2, true);
  survey.traces.resize(100);
  EXPECT_FALSE(mirrorDepth(survey.traces, survey.sonar, 1480, survey.path, kWater_m, {}));
  EXPECT_FALSE(mirrorDepth({}, survey.sonar, 1480, survey.path, kWater_m, {}));
}

}  // namespace
}  // namespace s2s::calib
