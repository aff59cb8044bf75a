#pragma once

#include "s2s/map/CSeabedSkyMap.h"

namespace s2s::test {

/// A small map with something in each field that is streamed, none at its default.
inline map::CSeabedSkyMap sampleMap() {
  using core::isometryFromXyzYpr;
  map::MapOptions options;
  options.insertion.interpolation = map::PoseInterpolation::ConstantVelocity;
  options.insertion.lidarVoxel_m = 0.25;
  options.insertion.stereoWindow_s = 0.07;
  options.resolver.gate = 2.5;
  options.likelihood.decimation = 3;
  options.view.maxPoints = 1234;
  map::CSeabedSkyMap map(options);
  map.genericMapParams.enableObservationLikelihood = false;
  map.addKeyframe({5, 1000, isometryFromXyzYpr(1, 2, 3, 0.1, 0.2, 0.3), isometryFromXyzYpr(4, 5, 6, 0.4, 0.5, 0.6)});
  map.addKeyframe({9, 3000, isometryFromXyzYpr(2, 2, 3, 0.1, 0.2, 0.3), isometryFromXyzYpr(5, 5, 6, 0.4, 0.5, 0.6)});
  const auto T_odom_vehicle = isometryFromXyzYpr(1.5, 2, 3, 0.1, 0.2, 0.3);
  map.insertScan(map::Layer::Lidar, 2000, T_odom_vehicle, {{{3, 4, 5}, 77, 0.02f}, {{-3, 4, 5}, 1000, 0.03f}});
  map.insertScan(map::Layer::Stereo, 2100, T_odom_vehicle, {{{1, 0, -2}, 200, 0.04f}});
  map::LineScan line;
  line.T_vehicle_sonar = isometryFromXyzYpr(-0.5, 0, -0.4, 0, 0.8, 0);
  line.verticalAperture_rad = 0.35;
  line.bearingModel = obs::BearingModel::Cone;
  line.bearingSigma_rad = 0.003;
  line.returns = {{5.5f, 0.4f, 120, 0.01f}, {6.5f, -0.4f, 90, 0.02f}};
  map.insertLineScan(map::Layer::LineHorizontal, 2200, T_odom_vehicle, line);
  map.insertLineScan(map::Layer::LineVertical, 2300, T_odom_vehicle, line);
  return map;
}

}  // namespace s2s::test
