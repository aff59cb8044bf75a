#pragma once

#include <string>
#include <vector>

#include "s2s/calib/options.h"
#include "s2s/graph/graph_slam_options.h"
#include "s2s/map/options.h"
#include "s2s/mapper/mapper_options.h"
#include "s2s/odometry/options.h"
#include "s2s/products/products_options.h"
#include "s2s/sonar/options_table.h"

namespace s2s::mapper {

/// All options of a run; every value has a default.
struct SurveyConfig {
  MapperOptions mapper;
  odometry::OdometryOptions odometry;
  sonar::SonarOptions sonar;
  graph::GraphSlamOptions graph;
  map::MapOptions map;
  products::ProductsOptions products;
  calib::CalibrationOptions calibration;  ///< only sonar-calibrate uses it
  calib::SwathOptions swath;              ///< likewise

  /// A vessel floats unless `mapper.onWater` says otherwise, so the graph's waterline prior is on; GNSS is welcome as
  /// a guest.
  SurveyConfig() { graph.waterline.enabled = graph.gnss.enabled = true; }
};

/// Reads an INI file over the defaults.
/// @param overrides "section.key=value", as given with --set; the last dot before '=' parts section and key
/// @throws core::ConfigError for anything unknown, unreadable or out of range
SurveyConfig loadSurveyConfig(const std::string& path, const std::vector<std::string>& overrides = {});

/// Every option with its value and its meaning, as an INI file that reads back to the same configuration.
std::string printSurveyConfig(const SurveyConfig& config);

}  // namespace s2s::mapper
