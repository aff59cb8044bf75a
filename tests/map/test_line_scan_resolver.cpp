#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "leading_edge_scene.h"
#include "map_points.h"

namespace {

using namespace s2s::map;
using namespace s2s::test;
using s2s::core::durationNs;
using s2s::core::Isometry;
using s2s::core::isometryFromXyzYpr;
using s2s::obs::BearingModel;

constexpr double kDepth_m = 3.0;  // of the seabed below the sonars' heads
constexpr double kSeabed_m = -0.4 - kDepth_m;

MapOptions withElevation(LineElevation elevation) {
  MapOptions options;
  options.insertion.lineElevation = elevation;
  options.insertion.lidarVoxel_m = 0;
  return options;
}

/// Heights of a layer's points over the level seabed.
std::vector<double> heightErrors(const CSeabedSkyMap& map, Layer layer) {
  std::vector<double> errors;
  for (const MapPoint& p : pointsOf(map, layer)) errors.push_back(p.p_map.z() - kSeabed_m);
  return errors;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double quantileOfSize(std::vector<double> values, double share) {
  for (double& v : values) v = std::abs(v);
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

/// A straight survey at 1 m/s: both sonars at 10 Hz, noise of 1 cm.
struct Survey {
  LeadingEdgeScene scene;
  Isometry T_start = Isometry::Identity();
  BearingModel model = BearingModel::Azimuth;
  double duration_s = 6;
  bool withVertical = true;
  int beams = 64;  // of the horizontal sonar

  Isometry pose(double t) const { return T_start * isometryFromXyzYpr(t, 0, 0, 0, 0, 0); }
  void run(CSeabedSkyMap& map) {
    for (int i = 0; i < static_cast<int>(10 * duration_s); ++i) {
      const double t = 0.1 * i;
      if (withVertical)
        map.insertLineScan(Layer::LineVertical, durationNs(t), pose(t),
                           scene.ping(pose(t), verticalMount(), kVerticalHalfFan, 256, model, 0.01));
      map.insertLineScan(Layer::LineHorizontal, durationNs(t), pose(t),
                         scene.ping(pose(t), horizontalMount(), kHorizontalHalfFan, beams, model, 0.01));
    }
  }
};

TEST(LineScanResolver, FlatSeabedZeroElevation_IsTooShallowByTheClosedForm) {
  LeadingEdgeScene scene;
  scene.add(LeadingEdgeScene::seabed(kSeabed_m));
  CSeabedSkyMap map(withElevation(LineElevation::Zero));
  map.insertLineScan(Layer::LineHorizontal, 0, Isometry::Identity(),
                     scene.ping(Isometry::Identity(), horizontalMount(), 1e-6, 2));
  // The echo comes from the lower edge, 55 degrees down; the imaging plane is 45 degrees down: 13.7 % of the depth.
  const double expected = kDepth_m * (1 - std::sin(45 * kDegree) / std::sin(55 * kDegree));
  EXPECT_NEAR(expected / kDepth_m, 0.137, 0.0005);
  EXPECT_NEAR(mean(heightErrors(map, Layer::LineHorizontal)), expected, 1e-5);  // ranges are single precision
}

TEST(LineScanResolver, FlatSeabedNothingKnown_LowerEdgeIsExactAndMarkedAsAGuess) {
  for (const BearingModel model : {BearingModel::Azimuth, BearingModel::Cone}) {
    LeadingEdgeScene scene;
    scene.add(LeadingEdgeScene::seabed(kSeabed_m));
    CSeabedSkyMap map(withElevation(LineElevation::Resolved));
    map.insertLineScan(Layer::LineHorizontal, 0, Isometry::Identity(),
                       scene.ping(Isometry::Identity(), horizontalMount(), kHorizontalHalfFan, 128, model));
    // The elevation is kept in steps of 0.1 mrad: 0.5 mm at the 10 m that the outer beams reach.
    EXPECT_LT(quantileOfSize(heightErrors(map, Layer::LineHorizontal), 1.0), 1e-3);
    EXPECT_EQ(map.elevationSources(Layer::LineHorizontal)[static_cast<std::size_t>(ElevationSource::Ambiguous)],
              map.pointCount(Layer::LineHorizontal));
    // The interval is the whole arc, at least that of the nearest seabed, 55 degrees down; 4 % steps.
    const double arc_m = kDepth_m / std::sin(55 * kDegree) * LeadingEdgeScene::kAperture_rad;
    for (const MapPoint& p : pointsOf(map, Layer::LineHorizontal)) EXPECT_GE(p.interval_m, arc_m * 0.999);
  }
}

TEST(LineScanResolver, NothingKnownAnyAttitude_TheArcHasNoLowerPoint) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> angle(-M_PI, M_PI), bearing(-1.1, 1.1);
  for (int i = 0; i < 500; ++i) {
    LineScanResolver resolver;
    resolver.reset({});
    StoredLineScan scan;
    scan.verticalAperture_rad = static_cast<float>(LeadingEdgeScene::kAperture_rad);
    scan.bearingModel = i % 2 ? BearingModel::Cone : BearingModel::Azimuth;
    PackedReturn r;
    r.range_m = 5;
    r.bearing_rad = static_cast<float>(bearing(random));
    scan.returns = {r};
    const Isometry T_map_sonar = isometryFromXyzYpr(0, 0, 0, angle(random), 0.5 * angle(random), angle(random));
    resolver.resolve(scan, T_map_sonar);
    const auto height = [&](double elevation_rad) {
      return (T_map_sonar * s2s::sonar::pointAt({r.range_m, r.bearing_rad, elevation_rad}, scan.bearingModel)).z();
    };
    double lowest = std::numeric_limits<double>::max();
    for (int k = -1000; k <= 1000; ++k) lowest = std::min(lowest, height(0.5 * scan.verticalAperture_rad * k / 1000.0));
    // Half a step of the stored elevation, 0.05 mrad, over 5 m.
    EXPECT_LT(height(scan.returns[0].elevation * kElevationStep_rad), lowest + 0.0003) << i;
  }
}

TEST(LineScanResolver, FlatSeabedSurvey_BiasVanishes) {
  for (const BearingModel model : {BearingModel::Azimuth, BearingModel::Cone}) {
    Survey survey;
    survey.model = model;
    survey.scene.add(LeadingEdgeScene::seabed(kSeabed_m));
    CSeabedSkyMap zero(withElevation(LineElevation::Zero)), resolved(withElevation(LineElevation::Resolved));
    survey.run(zero);
    survey.run(resolved);
    EXPECT_GT(mean(heightErrors(zero, Layer::LineHorizontal)), 0.3);
    // A range bin of these sonars is some 14 mm long. Range noise of 10 mm is taken down to 8 mm of height at 55 deg.
    const auto errors = heightErrors(resolved, Layer::LineHorizontal);
    EXPECT_LT(std::abs(mean(errors)), 0.014);
    EXPECT_LT(quantileOfSize(errors, 0.95), 0.05);
    EXPECT_LT(std::abs(mean(heightErrors(resolved, Layer::LineVertical))), 0.014);
    EXPECT_GT(resolved.elevationSources(Layer::LineHorizontal)[static_cast<std::size_t>(ElevationSource::Seabed)],
              100u);
  }
}

void checkThatTheEndIsLearnt(double beyond_deg, BearingModel model) {
  Survey survey;
  survey.model = model;
  survey.beams = 256;  // a ping tells where at least five of its beams meet the profile
  survey.duration_s = 12;
  survey.scene.add(LeadingEdgeScene::seabed(kSeabed_m));
  survey.scene.heardHalf_rad += beyond_deg * kDegree;
  CSeabedSkyMap map(withElevation(LineElevation::Resolved));
  survey.run(map);
  map.resolveLineScans();
  const auto& ends = map.apertureEnds();
  // The profile knows the bed to the 4 mm that noise of 1 cm leaves of the mean of some returns: 0.15 degrees.
  EXPECT_NEAR(ends[0].beyond_rad(), beyond_deg * kDegree, 0.15 * kDegree);
  // 120 pings are 12 m of path, thus twelve that are independent, and the first of these counts with the prior's 2 deg.
  EXPECT_LT(ends[0].sigma_rad(), 0.3 * kDegree);
  EXPECT_GT(ends[0].sigma_rad(), 0);
  EXPECT_EQ(ends[1].pings(), 0u);  // the upper edge meets nothing
  EXPECT_LT(std::abs(mean(heightErrors(map, Layer::LineHorizontal))), 0.01);
}

TEST(LineScanResolver, BedHeardBeyondTheNominalAperture_EndIsLearntAndTheBiasVanishes) {
  checkThatTheEndIsLearnt(0.8, BearingModel::Azimuth);
}

TEST(LineScanResolver, LastPartOfTheApertureSilent_EndIsLearntAndTheBiasVanishes) {
  checkThatTheEndIsLearnt(-0.7, BearingModel::Cone);
}

TEST(LineScanResolver, DimBedThenBrightBed_EachHasItsOwnEnd) {
  // 20 m of mud that is heard to the nominal end, then 20 m of sand that is heard 1 degree beyond it.
  LeadingEdgeScene mud, sand;
  for (LeadingEdgeScene* scene : {&mud, &sand}) scene->add(LeadingEdgeScene::seabed(kSeabed_m));
  sand.heardHalf_rad += 1 * kDegree;
  CSeabedSkyMap map(withElevation(LineElevation::Resolved));
  constexpr double kHalf_m = 20;
  for (double x = 0; x < 2 * kHalf_m; x += 0.2) {
    const Isometry T = isometryFromXyzYpr(x, 0, 0, 0, 0, 0);
    LeadingEdgeScene& scene = x < kHalf_m ? mud : sand;
    map.insertLineScan(Layer::LineVertical, durationNs(x), T,
                       scene.ping(T, verticalMount(), kVerticalHalfFan, 128, BearingModel::Azimuth, 0.01));
    map.insertLineScan(Layer::LineHorizontal, durationNs(x), T,
                       scene.ping(T, horizontalMount(), kHorizontalHalfFan, 256, BearingModel::Azimuth, 0.01));
  }
  map.resolveLineScans();
  std::vector<double> onMud, onSand;
  for (const MapPoint& p : pointsOf(map, Layer::LineHorizontal)) {
    const double taken_m = static_cast<double>(p.time) / 1e9;  // the path's place is the time in seconds
    if (taken_m < 8) onMud.push_back(p.p_map.z() - kSeabed_m);
    if (taken_m > 32) onSand.push_back(p.p_map.z() - kSeabed_m);
  }
  // One end for both, half a degree off, would make either some 2 cm wrong, in opposite ways. What one place knows by
  // its hundred pings is believed to four fifths, the rest is the survey's.
  EXPECT_LT(std::abs(mean(onMud)), 0.01);
  EXPECT_LT(std::abs(mean(onSand)), 0.01);
}

TEST(LineScanResolver, NominalEndBelieved_BedHeardBeyondItIsTooHighByTheClosedForm) {
  Survey survey;
  survey.scene.add(LeadingEdgeScene::seabed(kSeabed_m));
  survey.scene.heardHalf_rad += 0.8 * kDegree;
  MapOptions options = withElevation(LineElevation::Resolved);
  options.resolver.endSigma_rad = 0;
  CSeabedSkyMap map(options);
  survey.run(map);
  // How far down a beam pitched 45 degrees goes in a metre, at an elevation below its imaging plane.
  const auto down = [](double bearing_rad, double below_rad) {
    return std::sqrt(0.5) * (std::cos(below_rad) * std::cos(bearing_rad) + std::sin(below_rad));
  };
  double expected = 0;
  for (int beam = 0; beam < survey.beams; ++beam) {
    const double bearing_rad = kHorizontalHalfFan * (2.0 * beam / (survey.beams - 1) - 1);
    expected += kDepth_m * (1 - down(bearing_rad, 10 * kDegree) / down(bearing_rad, 10.8 * kDegree)) / survey.beams;
  }
  // Noise of 1 cm over 3840 returns is nothing; arcs whose gap is found at steps of 1.25 degrees make millimetres.
  EXPECT_NEAR(mean(heightErrors(map, Layer::LineHorizontal)), expected, 0.005);
}

TEST(LineScanResolver, OnlyTheHorizontalSonar_TheNominalEndStands) {
  Survey survey;
  survey.withVertical = false;
  survey.beams = 256;
  survey.scene.add(LeadingEdgeScene::seabed(kSeabed_m));
  survey.scene.heardHalf_rad += 0.8 * kDegree;
  CSeabedSkyMap map(withElevation(LineElevation::Resolved));
  survey.run(map);
  map.resolveLineScans();
  // Nobody else knows the bed: what the sonar made of its own arcs must not tell it where they end.
  for (const ApertureEnd& end : map.apertureEnds()) {
    EXPECT_EQ(end.pings(), 0u);
    EXPECT_EQ(end.beyond_rad(), 0);
    EXPECT_EQ(end.sigma_rad(), ResolverOptions().endSigma_rad);
  }
}

/// A quay wall at y = 4 m, in a seabed 5 m deep, seen by LiDAR above the water.
constexpr double kWall_m = 4.0;
void addCanal(LeadingEdgeScene& scene) {
  scene.add(LeadingEdgeScene::seabed(-5.4));
  scene.add({-Eigen::Vector3d::UnitY(), -kWall_m, [](const Eigen::Vector3d& p) { return p.z() < 2; }});
}

/// @param origin_m height of the vehicle's origin above the water
void insertLidarWall(CSeabedSkyMap& map, float origin_m = 0) {
  std::vector<ScanPoint> points;
  std::mt19937 random(3);
  std::normal_distribution<float> noise(0, 0.02f);
  for (float x = -8; x <= 14; x += 0.1f)
    for (float z = 0.1f; z <= 2; z += 0.1f)
      points.push_back({{x, static_cast<float>(kWall_m) + noise(random), z - origin_m}, 1, 0.02f});
  map.insertScan(Layer::Lidar, 0, isometryFromXyzYpr(0, 0, origin_m, 0, 0, 0), points);
}

/// Distances from the wall of the points that are nearer to it than to the seabed, positive on the water's side.
std::vector<double> wallErrors(const CSeabedSkyMap& map, double tolerance_m) {
  std::vector<double> errors;
  for (const MapPoint& p : pointsOf(map, Layer::LineHorizontal))
    if (p.p_map.z() > -5.4 + 0.5 && p.p_map.y() > kWall_m - tolerance_m) errors.push_back(kWall_m - p.p_map.y());
  return errors;
}

TEST(LineScanResolver, WallSeenObliquely_LiesWhereTheLidarSawIt) {
  for (const BearingModel model : {BearingModel::Azimuth, BearingModel::Cone}) {
    Survey survey;
    survey.model = model;
    survey.T_start = isometryFromXyzYpr(0, 0, 0, 20 * kDegree, 0, 0);  // heading toward the wall
    survey.duration_s = 3;
    survey.withVertical = false;
    addCanal(survey.scene);
    CSeabedSkyMap zero(withElevation(LineElevation::Zero)), resolved(withElevation(LineElevation::Resolved));
    insertLidarWall(resolved);
    survey.run(zero);
    survey.run(resolved);
    const auto zeroErrors = wallErrors(zero, 1.5), errors = wallErrors(resolved, 1.5);
    ASSERT_GT(errors.size(), 200u);
    EXPECT_GT(resolved.elevationSources(Layer::LineHorizontal)[static_cast<std::size_t>(ElevationSource::Wall)], 200u);
    // The arc's steps of 1.25 deg and the noise of 1 cm leave a few centimetres; the imaging plane alone is off by
    // more.
    EXPECT_LT(std::abs(mean(errors)), 0.02);
    EXPECT_LT(std::abs(mean(errors)), std::abs(mean(zeroErrors)));
    EXPECT_LT(quantileOfSize(errors, 0.9), 0.06);
  }
}

TEST(LineScanResolver, VehicleOriginOnDeck_WallsAboveTheWaterStillTell) {
  Survey survey;
  survey.T_start = isometryFromXyzYpr(0, 0, 0, 20 * kDegree, 0, 0);
  survey.duration_s = 1;
  survey.withVertical = false;
  addCanal(survey.scene);
  MapOptions options = withElevation(LineElevation::Resolved);
  options.waterline_m = -2.5;
  CSeabedSkyMap map(options);
  insertLidarWall(map, 2.5f);
  survey.run(map);
  EXPECT_GT(map.elevationSources(Layer::LineHorizontal)[static_cast<std::size_t>(ElevationSource::Wall)], 50u);
}

TEST(LineScanResolver, SeabedMetJustBeforeAWall_IsNotPulledOntoTheWall) {
  // The seabed is 3 m down and the wall 4 m to the side: for the outer beams both are about equally far away.
  Survey survey;
  survey.scene.add(LeadingEdgeScene::seabed(kSeabed_m));
  survey.scene.add({-Eigen::Vector3d::UnitY(), -kWall_m, [](const Eigen::Vector3d& p) { return p.z() < 2; }});
  CSeabedSkyMap map(withElevation(LineElevation::Resolved));
  insertLidarWall(map);
  survey.run(map);
  map.resolveLineScans();
  std::vector<double> errors;
  for (const MapPoint& p : pointsOf(map, Layer::LineHorizontal))
    errors.push_back(std::min(std::abs(p.p_map.z() - kSeabed_m), std::abs(p.p_map.y() - kWall_m)));
  // Noise of 1 cm for nearly all. At the foot of the wall both explain an echo within some centimetres; an arc that
  // ends short of the wall by the gate of three standard deviations, 17 cm, must not count as touching it.
  EXPECT_LT(quantileOfSize(errors, 0.98), 0.04);
  EXPECT_LT(quantileOfSize(errors, 1.0), 0.12);
}

TEST(LineScanResolver, SeabedKnownAndLowerEdgeSilent_ReturnIsPutWhereItsArcMeetsTheSeabed) {
  ResolverOptions options;
  LineScanResolver resolver;
  resolver.reset(options);
  for (double x = 0; x < 8; x += 0.05)
    for (double y = -2; y < 2; y += 0.05) resolver.addStereoPoint({x, y, kSeabed_m}, 0.01);
  StoredLineScan scan;
  scan.T_vehicle_sonar = horizontalMount();
  scan.verticalAperture_rad = static_cast<float>(LeadingEdgeScene::kAperture_rad);
  PackedReturn weak;
  // The echo of 50 degrees down: the aperture's lowest 5 degrees gave none above the threshold.
  weak.range_m = static_cast<float>(kDepth_m / std::sin(50 * kDegree));
  weak.rangeSigmaCode = encodeSigma(0.01);
  scan.returns = {weak};
  resolver.resolve(scan, Isometry::Identity());
  EXPECT_EQ(scan.returns[0].source, ElevationSource::Seabed);
  // The seabed is known to its roughness of 5 cm; the crossing itself is found to a part of an arc step.
  EXPECT_NEAR(scan.returns[0].elevation * kElevationStep_rad, -5 * kDegree, 0.3 * kDegree);
}

TEST(LineScanResolver, EchoFarAboveTheKnownSeabed_IsNotPulledOntoIt) {
  LineScanResolver resolver;
  resolver.reset({});
  for (double x = 0; x < 8; x += 0.05)
    for (double y = -2; y < 2; y += 0.05) resolver.addStereoPoint({x, y, kSeabed_m}, 0.01);
  StoredLineScan scan;
  scan.T_vehicle_sonar = horizontalMount();
  scan.verticalAperture_rad = static_cast<float>(LeadingEdgeScene::kAperture_rad);
  PackedReturn fish;
  fish.range_m = 2;
  scan.returns = {fish};
  resolver.resolve(scan, Isometry::Identity());
  EXPECT_EQ(scan.returns[0].source, ElevationSource::Ambiguous);
  // Anywhere on the arc of 0.70 m: seen from its lower end the root mean square is its length over the root of three.
  EXPECT_NEAR(decodeSigma(scan.returns[0].sigmaCode), 2 * LeadingEdgeScene::kAperture_rad / std::sqrt(3.0), 0.02);
}

TEST(LineScanResolver, FlatSeabedWithoutTheOtherSonar_NeighbouringArcsMakeTheSigmaHonest) {
  Survey survey;
  survey.withVertical = false;
  survey.scene.add(LeadingEdgeScene::seabed(kSeabed_m));
  CSeabedSkyMap map(withElevation(LineElevation::Resolved));
  survey.run(map);
  map.resolveLineScans();
  const auto sources = map.elevationSources(Layer::LineHorizontal);
  // All but the first and last pings' rims have neighbours.
  EXPECT_GT(sources[static_cast<std::size_t>(ElevationSource::LowestPoint)],
            0.9 * static_cast<double>(map.pointCount(Layer::LineHorizontal)));
  std::vector<double> claimed;
  for (const MapPoint& p : pointsOf(map, Layer::LineHorizontal))
    if (p.interval_m == 0) claimed.push_back(p.sigma_m);
  // 1 cm of range noise, 3 cm of relief, half a degree of the aperture's edge at 4 to 9 m: decimetres would be modesty.
  EXPECT_LT(quantileOfSize(claimed, 0.5), 0.08);
  EXPECT_LT(quantileOfSize(heightErrors(map, Layer::LineHorizontal), 0.95), 2 * quantileOfSize(claimed, 0.05));
}

/// A thin bar, 2 m long across the track and 1 m above the seabed: met first by one place of its own on each arc.
constexpr double kBarHeight_m = kSeabed_m + 1.0;
void addBar(LeadingEdgeScene& scene) {
  scene.add({-Eigen::Vector3d::UnitX(), -4.0,
             [](const Eigen::Vector3d& p) { return std::abs(p.y()) < 1 && std::abs(p.z() - kBarHeight_m) < 0.05; }});
}

TEST(LineScanResolver, SomethingAboveTheSeabed_AmbiguousIntervalsHoldIt) {
  Survey survey;
  survey.scene.add(LeadingEdgeScene::seabed(kSeabed_m));
  addBar(survey.scene);
  CSeabedSkyMap map(withElevation(LineElevation::Resolved));
  survey.run(map);
  map.resolveLineScans();
  std::size_t bars = 0, held = 0;
  for (const MapPoint& p : pointsOf(map, Layer::LineHorizontal)) {
    if (p.interval_m == 0 || std::abs(p.p_map.z() - kSeabed_m) < 0.15) continue;  // decided, or the seabed
    ++bars;
    const double off_m = std::hypot(p.p_map.x() - 4.0, p.p_map.z() - kBarHeight_m);
    if (off_m <= p.interval_m + 0.1) ++held;  // the bar is 10 cm thick
  }
  ASSERT_GT(bars, 50u);
  EXPECT_GE(static_cast<double>(held), 0.95 * static_cast<double>(bars));
}

TEST(LineScanResolver, WallBehindTheSeabed_IsFoundByTheSecondReturnAndOnlyWhereAWallIsKnown) {
  LeadingEdgeScene seabed, wall;
  seabed.add(LeadingEdgeScene::seabed(kSeabed_m));
  wall.add(
      {-Eigen::Vector3d::UnitY(), -kWall_m, [](const Eigen::Vector3d& p) { return p.z() < 2 && p.z() > kSeabed_m; }});
  CSeabedSkyMap map(withElevation(LineElevation::Resolved)), without(withElevation(LineElevation::Resolved));
  insertLidarWall(map);
  for (int i = 0; i < 20; ++i) {
    const Isometry T = isometryFromXyzYpr(0.1 * i, 0, 0, 0, 0, 0);
    LineScan scan = seabed.ping(T, horizontalMount(), kHorizontalHalfFan, 64);
    for (LineReturn r : wall.ping(T, horizontalMount(), kHorizontalHalfFan, 64).returns) {
      r.order = 1;
      scan.returns.push_back(r);
    }
    map.insertLineScan(Layer::LineHorizontal, durationNs(0.1 * i), T, scan);
    without.insertLineScan(Layer::LineHorizontal, durationNs(0.1 * i), T, scan);
  }
  const auto onWall = [](const CSeabedSkyMap& m) {
    std::vector<double> errors;
    m.forEachPoint(Layer::LineHorizontal, [&](const MapPoint& p) {
      if (p.p_map.z() > kSeabed_m + 0.3) errors.push_back(p.p_map.y() - kWall_m);
    });
    return errors;
  };
  ASSERT_GT(onWall(map).size(), 50u);
  // The LiDAR's wall is 2 cm thick by noise and not used for the distance: that is the sonar's own, without noise here.
  EXPECT_LT(quantileOfSize(onWall(map), 0.95), 0.06);
  EXPECT_EQ(onWall(without).size(), 0u);
  EXPECT_EQ(without.pointCount(Layer::LineHorizontal), 20u * 64u);
}

TEST(LineScanResolver, RidgeOfAWall_LiesWhereTheMeanOfWhatItsBeamSeesDoes) {
  LeadingEdgeScene seabed;
  seabed.add(LeadingEdgeScene::seabed(kSeabed_m));
  const double half_rad = 0.5 * LeadingEdgeScene::kAperture_rad;
  CSeabedSkyMap map(withElevation(LineElevation::Resolved));
  insertLidarWall(map);
  for (int i = 0; i < 60; ++i) {
    const Isometry T = isometryFromXyzYpr(0.1 * i, 0, 0, 0, 0, 0), T_map_sonar = T * horizontalMount();
    LineScan scan = seabed.ping(T, horizontalMount(), kHorizontalHalfFan, 64);
    for (double bearing_deg = 30; bearing_deg <= 60; bearing_deg += 2) {
      // The mean range of the wall over the elevations at which it is seen above the seabed.
      double sum_m = 0;
      int seen = 0;
      for (int step = -50; step <= 50; ++step) {
        const Eigen::Vector3d direction =
            T_map_sonar.linear() *
            s2s::sonar::pointAt({1, bearing_deg * kDegree, half_rad * step / 50}, BearingModel::Azimuth);
        const double range_m = (kWall_m - T_map_sonar.translation().y()) / direction.y();
        if ((T_map_sonar.translation() + range_m * direction).z() < kSeabed_m) continue;
        sum_m += range_m;
        ++seen;
      }
      if (seen < 10) continue;
      LineReturn ridge{static_cast<float>(sum_m / seen), static_cast<float>(bearing_deg * kDegree), 250, 0.01f, 1};
      ridge.isRidge = true;
      scan.returns.push_back(ridge);
    }
    map.insertLineScan(Layer::LineHorizontal, durationNs(0.1 * i), T, scan);
  }
  map.resolveLineScans();
  std::vector<double> errors;
  map.forEachPoint(Layer::LineHorizontal, [&](const MapPoint& p) {
    // Elsewhere the seabed at the wall's foot is not seen, so that the wall may go on below it.
    if (p.isWall && p.intensity == 250 && p.p_map.x() > 5 && p.p_map.x() < 7) errors.push_back(p.p_map.y() - kWall_m);
  });
  ASSERT_GT(errors.size(), 100u);
  double mean_m = 0;
  for (const double error : errors) mean_m += error / static_cast<double>(errors.size());
  // Taken as nearest places they would lie behind the wall by the mean of 1 / cos e, 0.5 % of 7 m. What is left comes
  // from the noise of the wall's planes (2 cm over some 60 points a cell) and from the foot, known to a step of the
  // arc: some millimetres.
  EXPECT_LT(std::abs(mean_m), 0.005);
  EXPECT_LT(quantileOfSize(errors, 0.95), 0.015);
}

TEST(LineScanResolver, EvidenceThatComesLater_CountsAfterResolvingAgain) {
  LeadingEdgeScene scene;
  scene.add(LeadingEdgeScene::seabed(kSeabed_m));
  CSeabedSkyMap map(withElevation(LineElevation::Resolved));
  map.insertLineScan(Layer::LineHorizontal, 0, Isometry::Identity(),
                     scene.ping(Isometry::Identity(), horizontalMount(), 1 * kDegree, 16));
  for (int i = 0; i < 20; ++i)
    map.insertLineScan(
        Layer::LineVertical, durationNs(1), isometryFromXyzYpr(-1 + 0.1 * i, 0, 0, 0, 0, 0),
        scene.ping(isometryFromXyzYpr(-1 + 0.1 * i, 0, 0, 0, 0, 0), verticalMount(), kVerticalHalfFan, 256));
  const auto seabed = static_cast<std::size_t>(ElevationSource::Seabed);
  EXPECT_EQ(map.elevationSources(Layer::LineHorizontal)[seabed], 0u);
  map.resolveLineScans();
  EXPECT_EQ(map.elevationSources(Layer::LineHorizontal)[seabed], 16u);
}

TEST(LineScanResolver, SeabedSlopesAcrossTheTrack_VerticalSonarLearnsItFromTheHorizontalOne) {
  // A bank of 15 degrees to the side: the vertical sonar is met first at that angle off its imaging plane.
  const double slope = std::tan(15 * kDegree);
  Survey survey;
  survey.scene.add({Eigen::Vector3d(0, -slope, 1), kSeabed_m, [](const Eigen::Vector3d&) { return true; }});
  CSeabedSkyMap zero(withElevation(LineElevation::Zero)), resolved(withElevation(LineElevation::Resolved));
  survey.run(zero);
  survey.run(resolved);
  resolved.resolveLineScans();
  const auto bankErrors = [&](const CSeabedSkyMap& map) {
    std::vector<double> errors;
    for (const MapPoint& p : pointsOf(map, Layer::LineVertical))
      if (p.p_map.x() < 6) errors.push_back(p.p_map.z() - slope * p.p_map.y() - kSeabed_m);
    return errors;
  };
  // In the imaging plane the points float above the bank by (1 / cos 15 - 1) of the depth, at most by what the 10
  // degrees of aperture reach. Met on the bank, half of that is gone; the rest is the grid's coarseness.
  EXPECT_GT(mean(bankErrors(zero)), 0.05);
  EXPECT_LT(std::abs(mean(bankErrors(resolved))), 0.5 * mean(bankErrors(zero)));
}

TEST(LineScanResolver, PosesMoved_EvidenceMovesAlong) {
  Survey survey;
  survey.scene.add(LeadingEdgeScene::seabed(kSeabed_m));
  CSeabedSkyMap map(withElevation(LineElevation::Resolved));
  const Isometry T_wrong = isometryFromXyzYpr(100, 50, 7, 1, 0, 0);
  map.addKeyframe({0, 0, Isometry::Identity(), T_wrong});
  survey.run(map);
  map.setKeyframePoses({{0, Isometry::Identity()}});
  map.resolveLineScans();
  const auto errors = heightErrors(map, Layer::LineHorizontal);
  EXPECT_LT(std::abs(mean(errors)), 0.014);  // a range bin, as in the survey above
  EXPECT_GT(map.elevationSources(Layer::LineHorizontal)[static_cast<std::size_t>(ElevationSource::Seabed)], 100u);
}

TEST(LineScanResolver, SigmaOfUnknownElevation_CoversTheTruthOnASteepSlope) {
  // A bank of 40 degrees ahead: the lowest point is wrong there, and the sigma must say so.
  Survey survey;
  survey.withVertical = false;
  survey.duration_s = 0.5;
  const Eigen::Vector3d normal = isometryFromXyzYpr(0, 0, 0, 0, -40 * kDegree, 0).linear() * Eigen::Vector3d::UnitZ();
  survey.scene.add({normal, normal.dot(Eigen::Vector3d(0, 0, -4))});
  CSeabedSkyMap map(withElevation(LineElevation::Resolved));
  survey.run(map);
  std::size_t covered = 0;
  const auto points = pointsOf(map, Layer::LineHorizontal);
  for (const MapPoint& p : points)
    if (std::abs(normal.dot(p.p_map) - normal.dot(Eigen::Vector3d(0, 0, -4))) <= 2 * p.sigma_m) ++covered;
  ASSERT_GT(points.size(), 100u);
  EXPECT_GE(static_cast<double>(covered), 0.95 * static_cast<double>(points.size()));  // two standard deviations
}

}  // namespace
