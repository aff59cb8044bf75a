#pragma once

#include <cstring>
#include <type_traits>
#include <vector>

namespace s2s::products {

// The writers copy numbers as they stand in memory.
static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the file writers are made for little-endian machines");

/// Appends the bytes of a number.
template <class Number>
void appendBytes(std::vector<char>& out, Number value) {
  static_assert(std::is_arithmetic_v<Number>);
  const std::size_t at = out.size();
  out.resize(at + sizeof(Number));
  std::memcpy(out.data() + at, &value, sizeof(Number));
}

/// Overwrites bytes of a record at a known place.
template <class Number>
void putBytes(std::vector<char>& out, std::size_t at, Number value) {
  static_assert(std::is_arithmetic_v<Number>);
  std::memcpy(out.data() + at, &value, sizeof(Number));
}

}  // namespace s2s::products
