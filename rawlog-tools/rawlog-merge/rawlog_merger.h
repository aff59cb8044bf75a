#pragma once

#include <iosfwd>
#include <map>
#include <string>
#include <vector>

#include "common/conversion_report.h"
#include "s2s/core/transform.h"

namespace s2s::tools::merge {

struct MergeOptions {
  std::vector<std::string> inputs;
  std::string output;
  int gzLevel = 0;
  /// Seconds to add to all times of an input, by its place in `inputs`; sensors recorded apart have clocks apart.
  std::map<std::size_t, double> offset_s;
  std::map<std::string, std::string> newLabel;             ///< by old label
  std::map<std::string, core::Isometry> T_vehicle_sensor;  ///< new sensor poses, by label (after renaming)
  /// Records of an input may be out of order by this much and are sorted; it bounds the memory.
  double reorderWindow_s = 1.0;
};

/// Merges rawlogs by time, reading all of them side by side. Every observation is kept but those that cannot be placed
/// in time. An observation without a label gets its class's name. A label or pose that fits no record is an error,
/// since it is a slip of the pen.
/// @param progress where to show progress; null for nowhere
/// @throws core::InputError, core::ConfigError, core::OutputError
ConversionReport mergeRawlogs(const MergeOptions& options, std::ostream* progress = nullptr);

}  // namespace s2s::tools::merge
