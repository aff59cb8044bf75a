#pragma once

#include <mrpt/obs/CObservation.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "s2s/core/time.h"

namespace s2s::obs {

/// What is wrong with a rawlog, and where.
struct RawlogFault {
  enum class Kind {
    UnknownClass,     ///< a record of a class that is not registered; nothing after it can be read
    DamagedRecord,    ///< a record that does not parse; nothing after it can be read
    TruncatedEnd,     ///< the file ends within a record
    NotAnObservation  ///< a readable record of a kind that holds no observation (skipped)
  };
  Kind kind;
  std::uint64_t record = 0;  ///< number of the record in the file, from 0
  std::uint64_t byte = 0;    ///< offset of the record in the uncompressed stream
  std::string text;          ///< one sentence with class name or parser message
  /// True if reading ended there.
  bool fatal() const { return kind != Kind::NotAnObservation; }
};

/// Streams the observations of a rawlog, gz-compressed or not, one at a time; never loads the whole file.
///
/// Observation-only rawlogs, sensory frames and action-frame pairs are read alike: frames are unpacked in order.
/// Stock MRPT stays silent at an unknown class, a damaged record or a truncated end; here each becomes a fault that
/// the caller sees. Records before the fault are delivered.
class RawlogReader {
 public:
  /// @throws core::InputError if the file is missing, unreadable, empty, or its first record does not parse
  explicit RawlogReader(const std::string& path);
  ~RawlogReader();

  /// The next observation, or null at the end (see `faults` for why).
  mrpt::obs::CObservation::Ptr next();

  /// Share of the file on disk that has been read, in [0, 1], for progress.
  double shareRead() const;

  const std::vector<RawlogFault>& faults() const { return faults_; }
  const std::string& path() const { return path_; }
  /// "survey.rawlog, record 12, byte 34567" for messages about the last observation.
  std::string where() const;

 private:
  struct Stream;
  mrpt::serialization::CSerializable::Ptr readRecord();
  void enqueue(const mrpt::serialization::CSerializable::Ptr& object);

  std::string path_;
  std::unique_ptr<Stream> stream_;
  std::vector<mrpt::obs::CObservation::Ptr> pending_;  // unpacked from a frame, last first
  std::vector<RawlogFault> faults_;
  std::uint64_t record_ = 0, nextRecord_ = 0, recordByte_ = 0;
  bool ended_ = false;
};

/// What a rawlog holds, from one pass over it.
struct RawlogSummary {
  struct Sensor {
    std::string className;
    std::uint64_t count = 0;
    core::TimeNs first = 0, last = 0;
  };
  std::map<std::string, Sensor> sensors;  ///< by sensor label
  std::uint64_t records = 0;
  core::TimeNs first = 0, last = 0;
  std::uint64_t backwards = 0;  ///< records older than the one before
  std::vector<RawlogFault> faults;
};

/// @throws core::InputError as RawlogReader does
RawlogSummary summarizeRawlog(const std::string& path);

}  // namespace s2s::obs
