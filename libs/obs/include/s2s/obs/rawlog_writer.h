#pragma once

#include <mrpt/obs/CObservation.h>

#include <cstdint>
#include <memory>
#include <string>

namespace s2s::obs {

struct RawlogWriterOptions {
  /// zlib level 1..9, or 0 for no compression at all: reading gz costs 25 times as much.
  int gzLevel = 0;
  /// Observations may come out of order by up to this; they are held back and sorted.
  double reorderWindow_s = 1.0;
  /// False: records are written as they come, as a recorder does whose clock jumps.
  bool sorted = true;
};

/// Writes an observation-only rawlog sorted by time. The file appears under its name when `close` succeeds.
class RawlogWriter {
 public:
  /// @throws core::OutputError if the file cannot be opened
  explicit RawlogWriter(const std::string& path, const RawlogWriterOptions& options = {});
  /// Without `close` nothing is left behind.
  ~RawlogWriter();
  RawlogWriter(const RawlogWriter&) = delete;
  RawlogWriter& operator=(const RawlogWriter&) = delete;

  /// The observation must not change afterwards: it is held until its turn comes.
  /// @throws core::InputError if it is older than what was already written, or has no time or no sensor label
  void write(const mrpt::obs::CObservation::Ptr& observation);

  /// Writes what is held back and gives the file its name.
  /// @throws core::OutputError if the disk is full or the file cannot be renamed
  void close();

  std::uint64_t count() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace s2s::obs
