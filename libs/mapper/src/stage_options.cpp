#include "s2s/mapper/stage_options.h"

namespace s2s::mapper {

OdometryStage::Options odometryStageOptions(const SurveyConfig& config) {
  OdometryStage::Options options;
  options.mapper = config.mapper;
  options.odometry = config.odometry;
  options.keyframes = config.graph.keyframes;
  options.sonar = config.sonar;
  auto& water = options.odometry.water;
  water.rejectBelow = config.mapper.onWater;
  water.heavePrior = water.heavePrior && config.mapper.onWater;
  water.velocityPrior = water.velocityPrior && config.mapper.onWater;
  options.odometry.seabed.enabled = options.odometry.seabed.enabled && config.mapper.onWater;
  water.height_m = config.mapper.waterline_m;
  water.margin_m = config.mapper.waterMargin_m;
  return options;
}

graph::GraphSlamOptions graphOptions(const SurveyConfig& config) {
  graph::GraphSlamOptions options = config.graph;
  options.waterline.enabled = options.waterline.enabled && config.mapper.onWater;
  options.waterline.height_m = -config.mapper.waterline_m;
  const bool seabedInOdometry = config.odometry.seabed.enabled && config.mapper.onWater;
  // The odometry forgets only when it has moved on by a tenth of its LiDAR map's radius.
  options.sonar.odometryMemory_m =
      seabedInOdometry ? config.odometry.seabed.map.radius_m + 0.1 * config.odometry.map.radius_m : 0;
  return options;
}

}  // namespace s2s::mapper
