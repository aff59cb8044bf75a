#include <gtest/gtest.h>
#include <mrpt/obs/CObservationIMU.h>

#include "lidar_scene.h"
#include "s2s/map/CSeabedSkyMap.h"

namespace {

using namespace s2s::map;
using s2s::core::Isometry;
using s2s::core::isometryFromXyzYpr;
using s2s::core::toPose;

const Isometry kSensor = isometryFromXyzYpr(0, 0, 1, 0, 0, 0);

/// The room of the scene, mapped from three places.
CSeabedSkyMap roomMap() {
  MapOptions options;
  options.insertion.lidarVoxel_m = 0.05;
  options.likelihood.mapVoxel_m = 0.05;
  options.likelihood.decimation = 3;
  CSeabedSkyMap map(options);
  for (const double x : {-4.0, 0.0, 3.0}) {
    const Isometry T = isometryFromXyzYpr(x, 0.3 * x, 0, 0.2 * x, 0, 0);
    map.insertObservation(*s2s::test::sweepInRoom(T, kSensor), toPose(T));
  }
  return map;
}

TEST(MapMatching, Likelihood_PeaksAtTheTruePose) {
  const CSeabedSkyMap map = roomMap();
  const Isometry T_true = isometryFromXyzYpr(1, -0.5, 0, 0.1, 0, 0);
  const auto sweep = s2s::test::sweepInRoom(T_true, kSensor);
  const double best = map.computeObservationLikelihood(*sweep, toPose(T_true));
  for (int axis = 0; axis < 6; ++axis)
    for (const double step : {-0.5, -0.2, 0.2, 0.5}) {
      double d[6] = {};
      d[axis] = axis < 3 ? step : 0.2 * step;  // metres, or radians
      const Isometry T = T_true * isometryFromXyzYpr(d[0], d[1], d[2], d[3], d[4], d[5]);
      EXPECT_LT(map.computeObservationLikelihood(*sweep, toPose(T)), best) << "axis " << axis << ", step " << step;
    }
}

TEST(MapMatching, Likelihood_OfPointsFarAway_IsBounded) {
  const CSeabedSkyMap map = roomMap();
  const auto sweep = s2s::test::sweepInRoom(Isometry::Identity(), kSensor);
  const double far = map.computeObservationLikelihood(*sweep, toPose(isometryFromXyzYpr(1e4, 0, 0, 0, 0, 0)));
  // Every used point counts as one of 1 m at a standard deviation of 0.1 m: -50 each, one of three points is used.
  EXPECT_NEAR(far, -50.0 * std::ceil(static_cast<double>(sweep->returnCount()) / 3), 1e-6);
}

TEST(MapMatching, Likelihood_OnlyOfWhatCarriesPoints) {
  const CSeabedSkyMap map = roomMap();
  EXPECT_TRUE(map.canComputeObservationLikelihood(*s2s::test::sweepInRoom(Isometry::Identity(), kSensor)));
  EXPECT_FALSE(map.canComputeObservationLikelihood(mrpt::obs::CObservationIMU()));
  EXPECT_FALSE(CSeabedSkyMap().canComputeObservationLikelihood(*s2s::test::sweepInRoom(Isometry::Identity(), kSensor)));
}

TEST(MapMatching, GraphUpdate_RenewsTheSearchedMap) {
  CSeabedSkyMap map = roomMap();
  const auto before = map.getAsSimplePointsMap()->size();
  ASSERT_GT(before, 1000u);
  std::map<std::uint64_t, Isometry> poses;
  for (const Keyframe& keyframe : map.keyframes())
    poses[keyframe.id] = isometryFromXyzYpr(0, 0, 50, 0, 0, 0) * keyframe.T_map_vehicle;
  map.setKeyframePoses(poses);
  const auto& z = map.getAsSimplePointsMap()->getPointsBufferRef_z();
  EXPECT_GT(*std::min_element(z.begin(), z.end()), 40.0f);
}

TEST(MapMatching, SameRoomFromElsewhere_MatchesAndAnotherPoseDoesNot) {
  const CSeabedSkyMap map = roomMap();
  CSeabedSkyMap other(map.options());
  const Isometry T = isometryFromXyzYpr(0.5, 0.2, 0, 0.05, 0, 0);
  other.insertObservation(*s2s::test::sweepInRoom(T, kSensor), toPose(T));
  mrpt::maps::TMatchingParams params;
  params.maxDistForCorrespondence = 0.3f;
  mrpt::maps::TMatchingRatioParams ratio;
  ratio.maxDistForCorr = 0.3f;
  const auto matched = [&](const Isometry& T_map_other) {
    mrpt::tfest::TMatchingPairList pairs;
    mrpt::maps::TMatchingExtraResults extra;
    map.determineMatching3D(&other, toPose(T_map_other), pairs, params, extra);
    return extra.correspondencesRatio;
  };
  EXPECT_GT(matched(Isometry::Identity()), 0.9f);
  EXPECT_LT(matched(isometryFromXyzYpr(0, 0, 3, 0, 0, 0)), 0.7f);
  EXPECT_GT(map.compute3DMatchingRatio(&other, mrpt::poses::CPose3D(), ratio), 0.9f);
}

}  // namespace
