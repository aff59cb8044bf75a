#pragma once

#include <mrpt/obs/CObservation.h>

#include <functional>
#include <iosfwd>
#include <string>

#include "s2s/mapper/fault_log.h"
#include "s2s/obs/rawlog_reader.h"

namespace s2s::mapper {

/// Which part of a rawlog to read, and where to tell how far it is.
struct SurveyReading {
  double from_s = 0;  ///< seconds from the first record; earlier ones are skipped
  double to_s = -1;   ///< seconds from the first record; negative: to the end
  std::string label;  ///< of the progress
  std::ostream* progress = nullptr;
};

/// Hands out the records of the chosen part with their places; the reader's faults go into the log. Records without a
/// time are handed out, too: whoever uses them counts them. Single records with a wrong time do not end the part.
/// @throws core::ConfigError if the part ends before it begins, core::InputError if the rawlog has no record in it
void readRecords(const SurveyReading& reading, obs::RawlogReader& reader, FaultLog& faults,
                 const std::function<void(const mrpt::obs::CObservation::Ptr&, const std::string& where)>& use);

}  // namespace s2s::mapper
