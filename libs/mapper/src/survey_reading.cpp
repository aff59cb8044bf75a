#include "survey_reading.h"

#include <algorithm>
#include <optional>

#include "s2s/core/error.h"
#include "s2s/core/progress.h"
#include "s2s/core/time.h"

namespace s2s::mapper {

namespace {

/// So many records in a row later than the part's end are its end; fewer are sensors that come early or a wrong time.
constexpr int kRecordsBeyond = 1000;

/// Total length of the survey in seconds, extrapolated from the share of the file that was read.
double expectedTotal_s(double done_s, double shareRead, const SurveyReading& reading) {
  const double all_s = shareRead > 0 ? done_s / shareRead : 0;
  const double end_s = reading.to_s > 0 ? std::min(reading.to_s, all_s) : all_s;
  return std::max(done_s, end_s - reading.from_s);
}

}  // namespace

void readRecords(const SurveyReading& reading, obs::RawlogReader& reader, FaultLog& faults,
                 const std::function<void(const mrpt::obs::CObservation::Ptr&, const std::string& where)>& use) {
  if (reading.to_s >= 0 && reading.to_s <= reading.from_s)
    throw core::ConfigError("the part of the survey ends before it begins", "--from, --to",
                            "give an end after the start");
  core::Progress progress(reading.progress, reading.label, 0, "s");
  std::optional<core::TimeNs> start;
  int beyond = 0;
  bool any = false;
  while (const auto observation = reader.next()) {
    const core::TimeNs time = core::fromMrptTime(observation->timestamp);
    if (time <= 0) {
      use(observation, reader.where());
      continue;
    }
    if (!start) start = time;
    const double elapsed_s = core::secondsBetween(*start, time);
    if (elapsed_s < reading.from_s) continue;
    if (reading.to_s >= 0 && elapsed_s > reading.to_s) {
      if (++beyond == kRecordsBeyond) break;
      continue;
    }
    beyond = 0;
    any = true;
    use(observation, reader.where());
    progress.setTotal(expectedTotal_s(elapsed_s, reader.shareRead(), reading) - std::max(0.0, reading.from_s));
    progress.update(elapsed_s - reading.from_s);
  }
  if (start && !any)
    throw core::InputError("the rawlog has no record in that part", reader.path(),
                           "--from and --to count seconds from the first record; rawlog-edit --info tells its length");
  for (const auto& fault : reader.faults())
    faults.add(fault.fatal() ? "reading ended early: " + fault.text : fault.text,
               reader.path() + ", record " + std::to_string(fault.record) + ", byte " + std::to_string(fault.byte));
}

}  // namespace s2s::mapper
