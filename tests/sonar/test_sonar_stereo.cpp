#include <gtest/gtest.h>

#include <set>
#include <tuple>

#include "s2s/core/error.h"
#include "s2s/sonar/sonar_stereo.h"
#include "synthetic_pings.h"

namespace s2s::sonar {
namespace {

using test::kDeg;
using test::TwinSonars;

/// Devices whose speckle-free brightness the synthetic pings have; only the intensity gates differ from the defaults.
SonarStereo stereoWith(const StereoOptions& options = {}) {
  DeviceOptions h = horizontalDefaults(), v = verticalDefaults();
  v.cfar.minIntensity = 80;
  return {h, v, options};
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 1e9 : values[values.size() / 2];
}

TEST(SonarStereo, LevelSeabed_GivesPointsOnIt) {
  const TwinSonars twins;
  const auto seabed = test::levelSeabed(3.0);
  const auto result = stereoWith().process(twins.horizontalPing(seabed), twins.verticalPing(seabed), twins.T_h_v());
  ASSERT_EQ(result.status, StereoStatus::Ok);
  EXPECT_GT(result.points.size(), 100u);
  std::vector<double> heights;
  std::size_t within2Sigma = 0;
  for (const auto& point : result.points) {
    const double height = std::abs((twins.T_level_h * point.p_h).z() + 3.0);
    heights.push_back(height);
    within2Sigma += height <= 2 * point.sigma_m() ? 1 : 0;
    EXPECT_LE(point.residual, 3.0);
  }
  // Beams of 0.18 degrees and, for one range, elevations that differ by 0.9 degrees over the azimuths of the aperture
  // (the cosine of 10 degrees): a quarter of that is 0.017 m at 4.2 m.
  EXPECT_LE(median(heights), 0.025);
  EXPECT_GE(static_cast<double>(within2Sigma), 0.9 * static_cast<double>(result.points.size()));
}

TEST(SonarStereo, Matches_UseEveryFeatureOnce) {
  const TwinSonars twins;
  const auto seabed = test::levelSeabed(3.0);
  const auto stereo = stereoWith();
  const auto h = stereo.horizontal().process(twins.horizontalPing(seabed));
  const auto v = stereo.vertical().process(twins.verticalPing(seabed));
  StereoTrace trace;
  const auto result = stereo.process(h, v, twins.T_h_v(), &trace);
  std::set<std::size_t> usedH, usedV;
  for (const auto& match : trace.matches) {
    EXPECT_TRUE(usedH.insert(match.horizontal).second);
    EXPECT_TRUE(usedV.insert(match.vertical).second);
    EXPECT_EQ(trace.features_h[match.horizontal].cluster >= 0, true);
  }
  EXPECT_EQ(result.counts.matches, trace.matches.size());
  EXPECT_EQ(
      result.points.size() + result.counts.outsideResidual + result.counts.outsideAperture + result.counts.outsideSigma,
      trace.matches.size());
}

TEST(SonarStereo, BeamsStoredFromTheOtherSide_ShowTheSame) {
  const TwinSonars twins;
  const auto seabed = test::levelSeabed(3.0);
  const auto ping_h = twins.horizontalPing(seabed), ping_v = twins.verticalPing(seabed);
  const auto stereo = stereoWith();
  const auto rising = stereo.horizontal().process(ping_h),
             falling = stereo.horizontal().process(test::fromOtherSide(ping_h));
  const auto returnsOf = [](const ProcessedPing& ping) {
    std::set<std::tuple<float, float, float, float>> returns;
    for (const auto& r : ping.lineScan.returns) returns.emplace(r.bearing_rad, r.range_m, r.intensity, r.rangeSigma_m);
    return returns;
  };
  ASSERT_GT(rising.lineScan.returns.size(), 200u);
  EXPECT_EQ(returnsOf(falling), returnsOf(rising));

  // The overlap is looked for in steps of some beams from the first one stored, so single features at its rim differ,
  // and with them the choice among about equally good matches; not what the points show.
  const auto result = stereo.process(test::fromOtherSide(ping_h), test::fromOtherSide(ping_v), twins.T_h_v());
  EXPECT_GT(result.points.size(), 100u);
  std::vector<double> heights;
  for (const auto& point : result.points) heights.push_back(std::abs((twins.T_level_h * point.p_h).z() + 3.0));
  EXPECT_LE(median(heights), 0.025);  // as above
}

TEST(SonarStereo, PoleOnTheSeabed_AppearsWhereItStands) {
  const TwinSonars twins;
  std::vector<Eigen::Vector3d> pole;
  // From the bed up to 1.2 m above it, facing the sonars; dense, so it is brighter than the bed.
  for (double z = -3.0; z < -1.8; z += 0.004)
    for (double a = -90; a <= 90; a += 3)
      for (int k = 0; k < 3; ++k)
        pole.emplace_back(3.2 - 0.05 * std::cos(a * kDeg), 0.25 + 0.05 * std::sin(a * kDeg), z);
  const auto result = stereoWith().process(twins.horizontalPing(pole), twins.verticalPing(pole), twins.T_h_v());
  ASSERT_EQ(result.status, StereoStatus::Ok);
  std::vector<double> sideways, distance;
  for (const auto& point : result.points) {
    const Eigen::Vector3d p = twins.T_level_h * point.p_h;
    sideways.push_back(std::abs(p.y() - 0.25));
    distance.push_back(std::hypot(p.x() - 3.2, p.y() - 0.25));
  }
  EXPECT_LE(median(sideways), 0.05);  // its radius
  EXPECT_LE(median(distance), 0.09);  // radius and a little over two bins
}

TEST(SonarStereo, MotionBetweenThePings_IsTakenOutByThePose) {
  TwinSonars twins;
  const auto seabed = test::levelSeabed(3.0);
  const auto h = twins.horizontalPing(seabed);
  // 33 ms later at 1.5 m/s and rolling at 20 degrees a second.
  twins.T_level_v = core::isometryFromXyzYpr(0.05, 0, 0, 0, 0, 0.7 * kDeg) * twins.T_level_v;
  const auto result = stereoWith().process(h, twins.verticalPing(seabed), twins.T_h_v());
  std::vector<double> heights;
  for (const auto& point : result.points) heights.push_back(std::abs((twins.T_level_h * point.p_h).z() + 3.0));
  EXPECT_LE(median(heights), 0.025);
}

TEST(SonarStereo, TwoSurfacesAtOneRange_AreRejectedAsAmbiguous) {
  // Two parallel bars across the view, at the same range but 10 degrees apart in elevation: for the horizontal sonar
  // one and the same; only the vertical sonar tells them apart, and no feature of the horizontal one can be given to
  // either with confidence.
  const TwinSonars twins;
  std::vector<Eigen::Vector3d> bars;
  for (double elevation = -6; elevation <= 6; elevation += std::abs(elevation + 4) < 1e-6 ? 8 : 0.1)
    for (double bearing = -9; bearing <= 9; bearing += 0.02)
      for (double range = 4.0; range < 4.15; range += 0.01)
        bars.push_back(twins.T_level_h *
                       pointAt({range, bearing * kDeg, elevation * kDeg}, obs::BearingModel::Azimuth));
  StereoOptions options;
  options.clusters.pairing = ClusterPairing::Overlap;
  const auto h = twins.horizontalPing(bars), v = twins.verticalPing(bars);
  const auto rejecting = stereoWith(options).process(h, v, twins.T_h_v());
  options.matching.ambiguity = AmbiguityRule::Keep;
  const auto keeping = stereoWith(options).process(h, v, twins.T_h_v());
  options.matching.ambiguity = AmbiguityRule::Ignore;
  const auto ignoring = stereoWith(options).process(h, v, twins.T_h_v());
  EXPECT_GT(rejecting.counts.ambiguous, 100u);
  EXPECT_LT(rejecting.counts.matches, ignoring.counts.matches / 4);
  ASSERT_FALSE(keeping.points.empty());
  std::vector<double> kept, careless;
  for (const auto& p : keeping.points) kept.push_back(p.sigma_m());
  for (const auto& p : ignoring.points) careless.push_back(p.sigma_m());
  EXPECT_GT(median(kept), 0.15);  // the bars are 0.7 m apart: half of that is the honest uncertainty
  EXPECT_LT(median(careless), 0.1);
}

TEST(SonarStereo, BlankPings_SayThereAreNoFeatures) {
  const auto result =
      stereoWith().process(test::emptyPing(), test::emptyPing(256, 700, 45 * kDeg), TwinSonars{}.T_h_v());
  EXPECT_EQ(result.status, StereoStatus::NoFeatures);
  EXPECT_TRUE(result.points.empty());
}

TEST(SonarStereo, EmptyPings_SayThereIsNoOverlap) {
  const obs::CObservationImagingSonar none;
  EXPECT_EQ(stereoWith().process(none, none, core::Isometry::Identity()).status, StereoStatus::NoOverlap);
}

TEST(SonarStereo, SonarOfOneBeam_IsTaken) {
  auto one = test::emptyPing(1);
  one.bearings_rad = {0};
  const core::Isometry T_h_v = core::isometryFromXyzYpr(0, 0, 0, 0, 0, M_PI / 2);
  auto fan = test::emptyPing();
  for (std::size_t bin = 300; bin < 310; ++bin) {
    test::setSample(one, bin, 0, 250);
    for (std::size_t beam = 200; beam < 312; ++beam) test::setSample(fan, bin, beam, 250);
  }
  EXPECT_NO_THROW(stereoWith().process(fan, one, T_h_v));
  EXPECT_NO_THROW(stereoWith().process(one, fan, T_h_v));
}

TEST(SonarStereo, DamagedPing_IsRefused) {
  auto ping = test::emptyPing();
  ping.bearings_rad.pop_back();
  EXPECT_THROW(stereoWith().process(ping, ping, core::Isometry::Identity()), core::InputError);
}

}  // namespace
}  // namespace s2s::sonar
