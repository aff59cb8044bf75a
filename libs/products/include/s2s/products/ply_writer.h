#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "s2s/core/atomic_file.h"
#include "s2s/map/map_point.h"

namespace s2s::products {

/// Writes map points as binary little-endian PLY, one at a time: a few megabytes of memory for any number of points.
///
/// Vertex properties: `double x y z` (metres, map frame, z up), `float intensity`, `float sigma` (metres),
/// `double time` (Unix seconds), `float interval` (metres of arc on which an ambiguous line-scan point may lie as well,
/// 0 if it is decided) and, when asked for, `uchar layer` (map::Layer).
class PlyPointWriter {
 public:
  enum class Columns { Plain, WithLayer };

  /// @throws core::OutputError if the file cannot be opened
  explicit PlyPointWriter(const std::string& path, Columns columns = Columns::Plain);

  void add(const map::MapPoint& point);
  std::uint64_t count() const { return count_; }

  /// Writes the final count into the header and gives the file its name; without it no file appears.
  /// @throws core::OutputError if writing failed
  void finish();

 private:
  void flush();

  core::AtomicFile file_;
  Columns columns_;
  std::uint64_t count_ = 0;
  std::vector<char> buffer_;
};

}  // namespace s2s::products
