#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace s2s::tools::pcd {

/// One column of a PCD file. `type` is 'F' (float), 'I' (signed) or 'U' (unsigned).
struct PcdField {
  std::string name;
  std::size_t size = 4;  ///< bytes of one element
  char type = 'F';
  std::size_t count = 1;  ///< elements a point
  std::size_t bytes() const { return size * count; }
};

enum class PcdEncoding { Ascii, Binary, BinaryCompressed };

/// The text that a PCD file begins with.
struct PcdHeader {
  std::vector<PcdField> fields;
  std::size_t pointCount = 0;
  bool hasViewpoint = false;  ///< a VIEWPOINT other than the identity
  PcdEncoding encoding = PcdEncoding::Ascii;
  std::size_t dataBegin = 0;  ///< offset of the first byte of data

  std::size_t bytesPerPoint() const;
  std::optional<std::size_t> fieldIndex(const std::string& name) const;
};

/// @param file the whole file
/// @param path its name, for errors
/// @throws core::InputError naming the line that is missing or wrong
PcdHeader parsePcdHeader(std::string_view file, const std::string& path);

}  // namespace s2s::tools::pcd
