#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "s2s/core/atomic_file.h"
#include "s2s/core/time.h"

namespace s2s::sim {

/// The surface point behind the strongest return of one beam.
struct StrongReturn {
  std::uint16_t beam = 0, bin = 0;
  float power_db = 0;         ///< mean echo power of that range bin before beam forming, re 1 uPa^2
  float x = 0, y = 0, z = 0;  ///< of the strongest patch in that bin, world frame
  std::uint32_t object = 0;   ///< id as in objects.csv
};
static_assert(sizeof(StrongReturn) == 24, "it is written as it lies in memory");

struct PingTruth {
  core::TimeNs time = 0;              ///< true time of the transmission
  std::uint32_t pingId = 0;           ///< as in the ping's record
  std::vector<StrongReturn> returns;  ///< by rising beam; beams without an echo above the noise are missing
};

/// Writes truth/returns_<LABEL>.bin: the line "S2S-RETURNS 1\n", then for each ping int64 time [ns since 1970],
/// uint32 pingId, uint32 count and `count` times a StrongReturn; little-endian.
class PingTruthWriter {
 public:
  /// @throws core::OutputError
  explicit PingTruthWriter(const std::string& path);
  void write(const PingTruth& ping);
  /// @throws core::OutputError
  void close();

 private:
  core::AtomicFile file_;
};

/// Reads what PingTruthWriter wrote, a ping at a time.
class PingTruthReader {
 public:
  /// @throws core::InputError if the file is missing or of another kind
  explicit PingTruthReader(const std::string& path);
  /// False at the end.
  /// @throws core::InputError if the file ends within a ping
  bool next(PingTruth& ping);

 private:
  std::string path_;
  std::ifstream in_;
};

}  // namespace s2s::sim
