#pragma once

#include <string>

#include "s2s/mapper/run_survey.h"
#include "s2s/products/run_summary.h"

namespace s2s::apps {

/// @throws core::ConfigError naming the first of rawlog, --config and --output that is missing
void requireMapArguments(const mapper::SurveyRun& run, const std::string& config);

/// What was read and made, and every warning, as lines for people.
std::string closingTable(const products::RunSummary& summary, const std::string& output);

}  // namespace s2s::apps
