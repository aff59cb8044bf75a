#include "s2s/obs/rawlog_writer.h"

#include <mrpt/io/CStream.h>
#include <mrpt/serialization/CArchive.h>
#include <zlib.h>

#include <algorithm>
#include <limits>
#include <map>

#include "s2s/core/atomic_file.h"
#include "s2s/core/error.h"
#include "s2s/core/time.h"

namespace s2s::obs {

using core::TimeNs;

namespace {

/// A write-only MRPT stream over zlib, compressed or not. MRPT's own file streams do not tell when the data that they
/// still held at the end could not be written.
class OutputStream : public mrpt::io::CStream {
 public:
  OutputStream(const std::string& path, int gzLevel)
      : file_(gzopen(path.c_str(), gzLevel == 0 ? "wbT" : ("wb" + std::to_string(gzLevel)).c_str())) {
    if (file_) gzbuffer(file_, 1u << 18);
  }
  ~OutputStream() override { close(); }
  OutputStream(const OutputStream&) = delete;
  OutputStream& operator=(const OutputStream&) = delete;

  bool isOpen() const { return file_ != nullptr; }
  /// False if anything could not be written.
  bool close() {
    if (!file_) return false;
    const int result = gzclose(file_);
    file_ = nullptr;
    return result == Z_OK;
  }

  std::size_t Write(const void* data, std::size_t count) override {
    const int written = count == 0 ? 0 : gzwrite(file_, data, static_cast<unsigned>(count));
    position_ += static_cast<std::uint64_t>(written);
    return static_cast<std::size_t>(written);
  }
  std::size_t Read(void*, std::size_t) override { return 0; }
  std::uint64_t Seek(std::int64_t, TSeekOrigin) override { return position_; }
  std::uint64_t getTotalBytesCount() const override { return position_; }
  std::uint64_t getPosition() const override { return position_; }

 private:
  gzFile file_;
  std::uint64_t position_ = 0;
};

}  // namespace

struct RawlogWriter::State {
  State(const std::string& finalPath, const RawlogWriterOptions& o)
      : path(finalPath), options(o), file(finalPath), stream(file.temporaryPath(), o.gzLevel) {}

  std::string path;
  RawlogWriterOptions options;
  core::AtomicFile file;
  OutputStream stream;
  std::multimap<TimeNs, mrpt::obs::CObservation::Ptr> held;  // equal times keep the order of arrival
  TimeNs newest = std::numeric_limits<TimeNs>::min(), written = std::numeric_limits<TimeNs>::min();
  std::uint64_t count = 0;

  void flushUntil(TimeNs limit) {
    auto archive = mrpt::serialization::archiveFrom(stream);
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
  if (!state_->stream.isOpen())
    throw core::OutputError("cannot open the rawlog for writing", path, "choose a folder you may write to");
}

RawlogWriter::~RawlogWriter() = default;

void RawlogWriter::write(const mrpt::obs::CObservation::Ptr& observation) {
  if (observation->timestamp == INVALID_TIMESTAMP)
    throw core::InputError("an observation has no time", "'" + observation->sensorLabel + "'", "set its timestamp");
  const TimeNs time = core::fromMrptTime(observation->timestamp);
  if (observation->sensorLabel.empty())
    throw core::InputError("an observation has no sensor label", core::formatUtc(time), "give the sensor a label");
  if (!state_->options.sorted) {
    constexpr TimeNs kAtOnce = std::numeric_limits<TimeNs>::min();
    state_->held.emplace(kAtOnce, observation);
    state_->flushUntil(kAtOnce);
    return;
  }
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
  if (!state_->stream.close())
    throw core::OutputError("writing the end failed", state_->path, "check that the disk has room");
  state_->file.commit();
}

std::uint64_t RawlogWriter::count() const { return state_->count + state_->held.size(); }

}  // namespace s2s::obs
