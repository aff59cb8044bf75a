#pragma once

#include <iosfwd>
#include <string>

#include "s2s/mapper/survey_config.h"
#include "s2s/products/run_summary.h"

namespace s2s::mapper {

/// One run from a rawlog to a folder of products.
struct SurveyRun {
  std::string rawlog;
  std::string output;  ///< folder; made when missing, other files in it are left alone
  double from_s = 0;   ///< seconds from the first record; earlier ones are skipped
  double to_s = -1;    ///< seconds from the first record; negative: to the end
  int threads = 2;
  std::string priorMap;   ///< output folder of an earlier run, in whose frame to map; empty: none
  bool realtime = false;  ///< replay at the recorded rate, drop what cannot be processed in time, measure latencies
  std::ostream* progress = nullptr;  ///< where progress goes; null: nowhere
};

/// Reads the rawlog, maps, and writes all products and the effective configuration.
/// @throws core::InputError if nothing can be mapped, core::OutputError, core::ConfigError
products::RunSummary runSurvey(const SurveyRun& run, const SurveyConfig& config);

}  // namespace s2s::mapper
