#include "s2s/obs/rawlog_writer.h"

#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/io/CFileOutputStream.h>
#include <mrpt/serialization/CArchive.h>

#include <map>

#include "s2s/core/atomic_file.h"
#include "s2s/core/error.h"
#include "s2s/core/time.h"

namespace s2s::obs {

using core::TimeNs;

struct RawlogWriter::State {
  State(const std::string& finalPath, const RawlogWriterOptions& o) : path(finalPath), options(o), file(finalPath) {}

  std::string path;
  RawlogWriterOptions options;
  core::AtomicFile file;
  std::unique_ptr<mrpt::io::CStream> stream;
  std::multimap<TimeNs, mrpt::obs::CObservation::Ptr> held;  // equal times keep the order of arrival
  TimeNs newest = std::numeric_limits<TimeNs>::min(), written = std::numeric_limits<TimeNs>::min();
  std::uint64_t count = 0;

  void flushUntil(TimeNs limit) {
    auto archive = mrpt::serialization::archiveFrom(*stream);
    while (!held.empty() && held.begin()->first <= limit) {
      try {
        archive << *held.begin()->second;
      } catch (const std::exception& e) {
        throw core::OutputError("writing a record failed", path, "check that the disk has room");
      }
      written = held.begin()->first;
      ++count;
      held.erase(held.begin());
    }
  }
};

RawlogWriter::RawlogWriter(const std::string& path, const RawlogWriterOptions& options)
    : state_(std::make_unique<State>(path, options)) {
  bool open = false;
  if (options.gzLevel == 0) {
    auto stream = std::make_unique<mrpt::io::CFileOutputStream>();
    open = stream->open(state_->file.temporaryPath(), mrpt::io::OpenMode::TRUNCATE);
    state_->stream = std::move(stream);
  } else {
    auto stream = std::make_unique<mrpt::io::CFileGZOutputStream>();
    open = stream->open(state_->file.temporaryPath(), options.gzLevel);
    state_->stream = std::move(stream);
  }
  if (!open) throw core::OutputError("cannot open the rawlog for writing", path, "choose a folder you may write to");
}

RawlogWriter::~RawlogWriter() = default;

void RawlogWriter::write(const mrpt::obs::CObservation::Ptr& observation) {
  const TimeNs time = core::fromMrptTime(observation->timestamp);
  if (observation->sensorLabel.empty())
    throw core::InputError("an observation has no sensor label", core::formatUtc(time), "give the sensor a label");
  if (time < state_->written)
    throw core::InputError("an observation comes " + core::formatDuration(core::secondsBetween(time, state_->written)) +
                               " too late to be sorted in",
                           "'" + observation->sensorLabel + "' at " + core::formatUtc(time),
                           "sort the source, or allow a longer reorder window");
  state_->held.emplace(time, observation);
  state_->newest = std::max(state_->newest, time);
  state_->flushUntil(state_->newest - core::durationNs(state_->options.reorderWindow_s));
}

void RawlogWriter::close() {
  state_->flushUntil(std::numeric_limits<TimeNs>::max());
  state_->stream.reset();
  state_->file.commit();
}

std::uint64_t RawlogWriter::count() const { return state_->count + state_->held.size(); }

}  // namespace s2s::obs
