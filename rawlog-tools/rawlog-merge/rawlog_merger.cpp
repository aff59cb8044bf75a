#include "rawlog-merge/rawlog_merger.h"

#include <cstdlib>
#include <filesystem>
#include <limits>
#include <set>

#include "s2s/core/error.h"
#include "s2s/core/progress.h"
#include "s2s/core/time.h"
#include "s2s/obs/rawlog_reader.h"
#include "s2s/obs/rawlog_writer.h"

namespace s2s::tools::merge {

namespace {

/// A record further ahead than this of the one behind it in its file has a damaged time.
constexpr core::TimeNs kFarAhead = 3600 * core::kNsPerSecond;

/// Half of what the type holds, some 146 years around 1970; MRPT's invalid time is beyond.
constexpr core::TimeNs kFarthest = std::numeric_limits<core::TimeNs>::max() / 2;

/// An observation and where it stands.
struct Record {
  mrpt::obs::CObservation::Ptr observation;  ///< null behind the end
  core::TimeNs time = 0;
  std::string where;
};

/// One input and its next two observations.
struct Input {
  Input(const std::string& path, core::TimeNs shift) : reader(path), offset_ns(shift) {
    std::error_code ignored;
    megabytes = 1e-6 * static_cast<double>(std::filesystem::file_size(path, ignored));
  }
  obs::RawlogReader reader;
  core::TimeNs offset_ns;
  double megabytes = 0;
  Record head, behind;
};

/// "mrpt::obs::CObservationGPS" without its namespaces.
std::string shortClassName(const mrpt::obs::CObservation& observation) {
  const std::string name = observation.GetRuntimeClass()->className;
  const auto colons = name.rfind("::");
  return colons == std::string::npos ? name : name.substr(colons + 2);
}

class Merger {
 public:
  explicit Merger(const MergeOptions& options) : options_(options) {
    if (options.inputs.empty()) throw core::ConfigError("no input", "", "name the rawlogs to merge");
    for (const auto& [place, seconds] : options.offset_s)
      if (place >= options.inputs.size())
        throw core::ConfigError("there is no input " + std::to_string(place + 1), "--offset",
                                "count the inputs from 1 to " + std::to_string(options.inputs.size()));
    for (std::size_t i = 0; i < options.inputs.size(); ++i) {
      const auto offset = options.offset_s.find(i);
      const double seconds = offset == options.offset_s.end() ? 0 : offset->second;
      inputs_.push_back(std::make_unique<Input>(options.inputs[i], core::durationNs(seconds)));
    }
  }

  ConversionReport run(std::ostream* progressStream) {
    double megabytes = 0;
    for (const auto& input : inputs_) megabytes += input->megabytes;
    core::Progress progress(progressStream, "merging", megabytes, "MB");
    obs::RawlogWriter writer(options_.output, {options_.gzLevel, options_.reorderWindow_s});
    for (auto& input : inputs_) {
      input->behind = read(*input);
      advance(*input);
    }
    while (Input* input = earliest()) {
      write(*input, writer);
      advance(*input);
      progress.update(megabytesRead());
    }
    rejectUnused();
    writer.close();
    for (const auto& input : inputs_) reportFaults(*input);
    return report_;
  }

 private:
  /// Reads on to the input's next observation that has a time.
  Record read(Input& input) {
    Record record;
    while ((record.observation = input.reader.next())) {
      const core::TimeNs time = core::fromMrptTime(record.observation->timestamp);
      if (std::abs(time) < kFarthest && std::abs(input.offset_ns) < kFarthest) {
        record.time = time + input.offset_ns;
        record.observation->timestamp = core::toMrptTime(record.time);
        record.where = input.reader.where();
        break;
      }
      report_.addSkipped("records without a usable time", input.reader.where());
    }
    return record;
  }

  /// To the next observation. One whose time is far ahead would be written after all others, and what stands behind it
  /// in its file would be too late.
  void advance(Input& input) {
    for (;;) {
      input.head = std::move(input.behind);
      if (!input.head.observation) return;
      input.behind = read(input);
      if (!input.behind.observation || input.head.time - input.behind.time <= kFarAhead) return;
      report_.addSkipped("records more than an hour ahead of the one behind them", input.head.where);
    }
  }

  Input* earliest() {
    Input* best = nullptr;
    for (auto& input : inputs_)
      if (input->head.observation && (!best || input->head.time < best->head.time)) best = input.get();
    return best;
  }

  void write(Input& input, obs::RawlogWriter& writer) {
    auto& observation = *input.head.observation;
    relabel(observation);
    const auto pose = options_.T_vehicle_sensor.find(observation.sensorLabel);
    if (pose != options_.T_vehicle_sensor.end()) {
      observation.setSensorPose(core::toPose(pose->second));
      used_.insert(pose->first);
    }
    try {
      writer.write(input.head.observation);
      report_.addRead("observations of " + observation.sensorLabel);
    } catch (const core::InputError& e) {
      report_.addSkipped("records that are out of order by more than " +
                             core::formatDuration(options_.reorderWindow_s) + " (see --window)",
                         input.head.where);
    }
  }

  void relabel(mrpt::obs::CObservation& observation) {
    const auto renamed = options_.newLabel.find(observation.sensorLabel);
    if (renamed != options_.newLabel.end()) {
      used_.insert(renamed->first);
      observation.sensorLabel = renamed->second;
    } else if (observation.sensorLabel.empty()) {
      observation.sensorLabel = shortClassName(observation);
      report_.addNote("records without a sensor label got their class's name, " + observation.sensorLabel);
    }
  }

  void rejectUnused() const {
    for (const auto& [label, replacement] : options_.newLabel) rejectIfUnused(label, "--label");
    for (const auto& [label, pose] : options_.T_vehicle_sensor) rejectIfUnused(label, "--pose");
  }

  void rejectIfUnused(const std::string& label, const std::string& option) const {
    if (used_.count(label) != 0) return;
    std::string known;
    for (const auto& line : report_.read()) known += (known.empty() ? "" : ", ") + line.text;
    throw core::ConfigError("no observation has the label '" + label + "'", option, "the inputs hold " + known);
  }

  void reportFaults(const Input& input) {
    for (const auto& fault : input.reader.faults()) {
      const std::string where =
          input.reader.path() + ", record " + std::to_string(fault.record) + ", byte " + std::to_string(fault.byte);
      report_.addSkipped((fault.fatal() ? "rest of an input: " : "records: ") + fault.text, where);
    }
  }

  double megabytesRead() const {
    double sum = 0;
    for (const auto& input : inputs_) sum += input->megabytes * input->reader.shareRead();
    return sum;
  }

  const MergeOptions& options_;
  std::vector<std::unique_ptr<Input>> inputs_;
  std::set<std::string> used_;
  ConversionReport report_;
};

}  // namespace

ConversionReport mergeRawlogs(const MergeOptions& options, std::ostream* progress) {
  return Merger(options).run(progress);
}

}  // namespace s2s::tools::merge
