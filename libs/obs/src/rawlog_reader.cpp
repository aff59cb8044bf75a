#include "s2s/obs/rawlog_reader.h"

#include <mrpt/io/CStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>
#include <zlib.h>

#include <algorithm>
#include <filesystem>

#include "s2s/core/error.h"
#include "s2s/obs/register_classes.h"

namespace s2s::obs {

namespace fs = std::filesystem;

/// A read-only MRPT stream over zlib that counts bytes and remembers where and how the data ended.
struct RawlogReader::Stream : public mrpt::io::CStream {
  explicit Stream(const std::string& path) : file(gzopen(path.c_str(), "rb")) {
    if (file) gzbuffer(file, 1u << 18);
  }
  ~Stream() override {
    if (file) gzclose(file);
  }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  std::size_t Read(void* buffer, std::size_t count) override {
    const int got = gzread(file, buffer, static_cast<unsigned>(count));
    if (got < static_cast<int>(count)) {
      ended = true;
      int code = Z_OK;
      const char* text = gzerror(file, &code);
      if (code != Z_OK) zlibError = text;
    }
    if (got < 0) return 0;
    position += static_cast<std::uint64_t>(got);
    return static_cast<std::size_t>(got);
  }
  std::size_t Write(const void*, std::size_t) override { return 0; }
  std::uint64_t Seek(std::int64_t, TSeekOrigin) override { return position; }
  std::uint64_t getTotalBytesCount() const override { return 0; }
  std::uint64_t getPosition() const override { return position; }

  gzFile file;
  std::uint64_t position = 0;
  std::uint64_t fileSize = 0;
  bool ended = false;
  std::string zlibError;
};

namespace {

std::string firstLineAfter(const std::string& text, std::size_t begin) {
  begin = text.find_first_not_of(" \t\n", begin);
  return begin == std::string::npos ? "no reason given" : text.substr(begin, text.find('\n', begin) - begin);
}

/// The cause of an MRPT exception: the message of the innermost one that it quotes, without the backtraces, after the
/// name of the class that did not parse.
std::string cause(const std::exception& e) {
  const std::string text = e.what();
  const std::string quote = "Original exception:", label = "Message:", object = "typed object '";
  std::string className;
  if (const auto name = text.find(object); name != std::string::npos) {
    className = text.substr(name + object.size(), text.find('\'', name + object.size()) - name - object.size());
    className = className.find(' ') == std::string::npos ? className + ": " : "";  // else it is the stream's name
  }
  const auto innermost = text.rfind(quote);
  std::size_t begin = innermost == std::string::npos ? 0 : innermost + quote.size();
  if (firstLineAfter(text, begin).rfind("====", 0) == 0) begin = text.find(label, begin) + label.size();
  return className + firstLineAfter(text, begin);
}

}  // namespace

RawlogReader::RawlogReader(const std::string& path) : path_(path) {
  registerClasses();
  std::error_code error;
  if (!fs::exists(path, error)) throw core::InputError("the rawlog does not exist", path, "check the path");
  if (!fs::is_regular_file(path, error))
    throw core::InputError("this is not a file", path, "give the .rawlog file itself");
  stream_ = std::make_unique<Stream>(path);
  if (!stream_->file) throw core::InputError("cannot open the rawlog", path, "check that you may read it");
  stream_->fileSize = fs::file_size(path, error);
  if (stream_->fileSize == 0)
    throw core::InputError("the rawlog is empty (0 bytes)", path,
                           "its recorder was probably killed before it wrote anything; record again");

  while (pending_.empty() && !ended_)
    if (const auto object = readRecord()) enqueue(object);
  if (pending_.empty() && nextRecord_ == 0) {
    const std::string reason = faults_.empty() ? "no record" : faults_.front().text;
    throw core::InputError("not a readable rawlog: " + reason, path,
                           "check that this is an MRPT rawlog, and that all its classes are known here");
  }
}

RawlogReader::~RawlogReader() = default;

mrpt::obs::CObservation::Ptr RawlogReader::next() {
  while (pending_.empty() && !ended_)
    if (const auto object = readRecord()) enqueue(object);
  if (pending_.empty()) return nullptr;
  auto observation = std::move(pending_.back());
  pending_.pop_back();
  return observation;
}

mrpt::serialization::CSerializable::Ptr RawlogReader::readRecord() {
  const std::uint64_t start = stream_->position;
  const auto fail = [&](RawlogFault::Kind kind, const std::string& text) {
    faults_.push_back({kind, nextRecord_, start, text});
    ended_ = true;
    return nullptr;
  };
  try {
    auto archive = mrpt::serialization::archiveFrom(*stream_);
    auto object = archive.ReadObject();
    record_ = nextRecord_++;
    recordByte_ = start;
    return object;
  } catch (const std::exception& e) {
    if (!stream_->zlibError.empty())
      return fail(RawlogFault::Kind::TruncatedEnd, "the compressed data ends or is damaged: " + stream_->zlibError);
    if (stream_->ended && stream_->position == start) {
      ended_ = true;  // the clean end
      return nullptr;
    }
    if (stream_->ended)
      return fail(RawlogFault::Kind::TruncatedEnd,
                  "the file ends within a record, after " + std::to_string(stream_->position - start) + " bytes of it");
    const std::string message = cause(e);
    const bool unknown = message.find("not registered") != std::string::npos;
    return fail(unknown ? RawlogFault::Kind::UnknownClass : RawlogFault::Kind::DamagedRecord, message);
  }
}

void RawlogReader::enqueue(const mrpt::serialization::CSerializable::Ptr& object) {
  if (auto observation = std::dynamic_pointer_cast<mrpt::obs::CObservation>(object)) {
    pending_.push_back(std::move(observation));
  } else if (const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object)) {
    pending_.assign(frame->begin(), frame->end());
    std::reverse(pending_.begin(), pending_.end());
  } else if (!std::dynamic_pointer_cast<mrpt::obs::CActionCollection>(object)) {
    faults_.push_back({RawlogFault::Kind::NotAnObservation, record_, recordByte_,
                       std::string("skipped a ") + object->GetRuntimeClass()->className});
  }
}

double RawlogReader::shareRead() const {
  return static_cast<double>(gzoffset(stream_->file)) / static_cast<double>(stream_->fileSize);
}

std::string RawlogReader::where() const {
  return path_ + ", record " + std::to_string(record_) + ", byte " + std::to_string(recordByte_);
}

RawlogSummary summarizeRawlog(const std::string& path) {
  RawlogSummary summary;
  RawlogReader reader(path);
  while (const auto observation = reader.next()) {
    const core::TimeNs time = core::fromMrptTime(observation->timestamp);
    auto& sensor = summary.sensors[observation->sensorLabel];
    if (sensor.count++ == 0) {
      sensor.className = observation->GetRuntimeClass()->className;
      sensor.first = sensor.last = time;
    }
    sensor.first = std::min(sensor.first, time);
    sensor.last = std::max(sensor.last, time);
    if (summary.records == 0) summary.first = summary.last = time;
    if (time < summary.last) ++summary.backwards;
    summary.first = std::min(summary.first, time);
    summary.last = std::max(summary.last, time);
    ++summary.records;
  }
  summary.faults = reader.faults();
  return summary;
}

}  // namespace s2s::obs
