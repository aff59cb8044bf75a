#pragma once

#include "s2s/graph/graph_slam_options.h"
#include "s2s/mapper/odometry_stage.h"
#include "s2s/mapper/survey_config.h"

namespace s2s::mapper {

/// What a survey's configuration means to single stages; the water stands once in [mapper] and is told to all.
OdometryStage::Options odometryStageOptions(const SurveyConfig& config);
graph::GraphSlamOptions graphOptions(const SurveyConfig& config);

}  // namespace s2s::mapper
