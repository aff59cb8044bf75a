#include <gtest/gtest.h>

#include <random>

#include "s2s/sonar/ping_geometry.h"
#include "s2s/sonar/surface_model.h"

namespace s2s::sonar {
namespace {

constexpr double kDeg = M_PI / 180.0;
constexpr double kAperture = 20 * kDeg;

/// What both sonars see of the plane q . p = 1: every pixel of the horizontal one within the aperture, and for each
/// range the mean elevation over all azimuths, which is all the vertical one tells. Beams begin late by `clutter_m` on
/// average; strips of a degree end early by `weak_m` on average, where the echo has become too weak.
std::vector<ElevationSample> samplesOf(const Eigen::Vector3d& q, double clutter_m = 0, double weak_m = 0) {
  std::vector<ElevationSample> samples;
  std::vector<double> elevations;
  std::map<long, std::pair<double, int>> rows;
  std::mt19937 random(1);
  std::exponential_distribution<double> late(1 / std::max(clutter_m, 1e-9)), early(1 / std::max(weak_m, 1e-9));
  std::map<long, double> ends;
  for (double bearing = -10; bearing <= 10; bearing += 0.25) {
    const double begin = clutter_m > 0 ? late(random) : 0;
    const double end = weak_m > 0 ? ends.try_emplace(std::lround(bearing), early(random)).first->second : 0;
    double nearest = 1e9, farthest = 0;
    std::vector<std::pair<double, double>> column;
    for (double elevation = -10; elevation <= 10; elevation += 0.1) {
      const double range = 1 / q.dot(pointAt({1, bearing * kDeg, elevation * kDeg}, obs::BearingModel::Azimuth));
      nearest = std::min(nearest, range);
      farthest = std::max(farthest, range);
      column.emplace_back(range, elevation * kDeg);
    }
    for (const auto& [range, elevation] : column) {
      if (range < nearest + begin || range > farthest - end) continue;
      samples.push_back({range, bearing * kDeg, true, 0});
      elevations.push_back(elevation);
      auto& row = rows[std::lround(range / 0.02)];
      row.first += elevation;
      ++row.second;
    }
  }
  for (auto& s : samples) {
    const auto& row = rows[std::lround(s.range_m / 0.02)];
    s.meanElevation_rad = row.first / row.second;
  }
  return samples;
}

/// A seabed 3 m below, the sonar pitched 45 degrees down, tilted sideways by `tilt`.
Eigen::Vector3d seabed(double tilt) { return Eigen::Vector3d(0.707, tilt, -0.707) / 3.0; }

double worstElevationError(const SurfaceModel& model, const Eigen::Vector3d& q) {
  double worst = 0;
  for (double bearing = -9; bearing <= 9; bearing += 3)
    for (double elevation = -7; elevation <= 7; elevation += 2) {
      const double range = 1 / q.dot(pointAt({1, bearing * kDeg, elevation * kDeg}, obs::BearingModel::Azimuth));
      const auto found = model.elevation(range, bearing * kDeg);
      EXPECT_TRUE(found.has_value());
      if (found) worst = std::max(worst, std::abs(*found - elevation * kDeg));
    }
  return worst / kDeg;
}

TEST(SurfaceModel, TiltedPlane_GivesEachBeamItsOwnElevation) {
  for (const double tilt : {-0.3, -0.1, 0.0, 0.1, 0.3}) {
    const auto model = SurfaceModel::fit(samplesOf(seabed(tilt)), kAperture, {});
    ASSERT_TRUE(model.has_value()) << tilt;
    EXPECT_LT((model->plane() - seabed(tilt)).norm(), 0.01) << tilt;  // rows of 6 cm blur it a little
    // Rows of 6 cm hold elevations 0.7 degrees apart, so half of that is the model's own resolution.
    EXPECT_LT(worstElevationError(*model, seabed(tilt)), 0.45) << tilt;
  }
}

TEST(SurfaceModel, LateEdges_OnlyBlurTheTilt) {
  const auto q = seabed(0.2);
  const auto model = SurfaceModel::fit(samplesOf(q, 0.06), kAperture, {});
  ASSERT_TRUE(model.has_value());
  // Edges late by 6 cm on average and in scatter: 80 beams tell the slope to 6 cm / sqrt(80) over the fan's half.
  EXPECT_LT((model->plane() - q).norm(), 0.02);
}

TEST(SurfaceModel, WeakFarEdges_LeaveTheTiltToTheNearOnes) {
  for (const double tilt : {-0.2, 0.2}) {
    const auto q = seabed(tilt);
    const auto model = SurfaceModel::fit(samplesOf(q, 0.02, 0.15), kAperture, {});
    ASSERT_TRUE(model.has_value()) << tilt;
    // Near edges late by 2 cm in 21 strips tell q_y to 0.02 m / (3.6 m)^2 / (sqrt(21) * 0.1) = 0.003; three times that.
    EXPECT_NEAR(model->plane().y(), q.y(), 0.01) << tilt;
  }
}

TEST(SurfaceModel, SurfaceSquareToTheSonar_IsRefused) {
  EXPECT_FALSE(SurfaceModel::fit(samplesOf(Eigen::Vector3d(0.25, 0.01, 0.01)), kAperture, {}).has_value());
}

TEST(SurfaceModel, RaggedEdges_AreRefused) {
  // Every other degree shows only the far half of the bed, those between only the near half.
  auto samples = samplesOf(seabed(0));
  const auto isHidden = [](const ElevationSample& s) {
    return std::lround(s.bearing_rad / kDeg) % 2 == 0 ? s.range_m < 4.4 : s.range_m > 4.4;
  };
  samples.erase(std::remove_if(samples.begin(), samples.end(), isHidden), samples.end());
  EXPECT_FALSE(SurfaceModel::fit(samples, kAperture, {}).has_value());
}

TEST(SurfaceModel, FewSamples_AreRefused) {
  EXPECT_FALSE(SurfaceModel::fit({}, kAperture, {}).has_value());
  auto samples = samplesOf(seabed(0));
  samples.resize(10);
  EXPECT_FALSE(SurfaceModel::fit(samples, kAperture, {}).has_value());
}

TEST(SurfaceModel, RangeWithoutARow_HasNoElevation) {
  const auto model = SurfaceModel::fit(samplesOf(seabed(0)), kAperture, {});
  ASSERT_TRUE(model.has_value());
  EXPECT_FALSE(model->elevation(9.0, 0).has_value());
}

}  // namespace
}  // namespace s2s::sonar
