#pragma once

#include <string>
#include <utility>
#include <vector>

#include "s2s/core/option_table.h"
#include "s2s/graph/graph_slam_options.h"

namespace s2s::graph {

/// INI keys of each options struct; see core::OptionTable.
core::OptionTable optionTable(KeyframePolicyOptions& options);
core::OptionTable optionTable(LoopSearchOptions& options);
core::OptionTable optionTable(ScanContextOptions& options);
core::OptionTable optionTable(RegistrationOptions& options);
core::OptionTable optionTable(ConsistencyOptions& options);
core::OptionTable optionTable(OptimizerOptions& options);
core::OptionTable optionTable(GnssOptions& options);
core::OptionTable optionTable(WaterlineOptions& options);
core::OptionTable optionTable(FalseClosureOptions& options);
core::OptionTable optionTable(RelocationOptions& options);
core::OptionTable optionTable(SonarFactorOptions& options);
/// The keys of GraphSlamOptions itself, without those of its parts.
core::OptionTable optionTable(GraphSlamOptions& options);

/// All of these with their INI sections: `prefix`, `prefix.keyframes`, `prefix.loops`, … They refer to `options`.
std::vector<std::pair<std::string, core::OptionTable>> optionSections(GraphSlamOptions& options,
                                                                      const std::string& prefix = "graph");

}  // namespace s2s::graph
