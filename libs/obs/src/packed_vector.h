#pragma once

#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace s2s::obs {

/// Streams a vector of numbers of type T as values of a narrower type that holds them all, so that a sweep with short
/// ranges takes half the room. Lossless.
namespace packed {

/// More elements than any sensor delivers in one record: a count above it is damage, and must not be allocated.
constexpr std::uint32_t kMaxCount = 1u << 26;

template <class T, class Narrow>
void writeAs(mrpt::serialization::CArchive& out, const std::vector<T>& values) {
  out << static_cast<std::uint8_t>(sizeof(Narrow));
  const std::vector<Narrow> narrow(values.begin(), values.end());
  if (!narrow.empty()) out.WriteBufferFixEndianness(narrow.data(), narrow.size());
}

template <class T, class Narrow>
void readAs(mrpt::serialization::CArchive& in, std::vector<T>& values) {
  std::vector<Narrow> narrow(values.size());
  if (!narrow.empty()) in.ReadBufferFixEndianness(narrow.data(), narrow.size());
  std::copy(narrow.begin(), narrow.end(), values.begin());
}

/// For unsigned integers: the narrowest of 1, 2 and sizeof(T) bytes. For other types: as they are.
template <class T>
void write(mrpt::serialization::CArchive& out, const std::vector<T>& values) {
  out << static_cast<std::uint32_t>(values.size());
  if constexpr (std::is_unsigned_v<T>) {
    T largest = 0;
    for (const T value : values) largest = std::max(largest, value);
    if (sizeof(T) > 1 && largest <= std::numeric_limits<std::uint8_t>::max())
      return writeAs<T, std::uint8_t>(out, values);
    if (sizeof(T) > 2 && largest <= std::numeric_limits<std::uint16_t>::max())
      return writeAs<T, std::uint16_t>(out, values);
  }
  out << static_cast<std::uint8_t>(sizeof(T));
  if (!values.empty()) out.WriteBufferFixEndianness(values.data(), values.size());
}

template <class T>
void read(mrpt::serialization::CArchive& in, std::vector<T>& values, const char* field) {
  const auto count = in.ReadAs<std::uint32_t>();
  const auto width = in.ReadAs<std::uint8_t>();
  if (count > kMaxCount)
    throw std::runtime_error(std::string(field) + " claims " + std::to_string(count) + " elements");
  values.resize(count);
  if (width == sizeof(T)) {
    if (count) in.ReadBufferFixEndianness(values.data(), count);
    return;
  }
  if constexpr (std::is_unsigned_v<T>) {
    if (width == 1) return readAs<T, std::uint8_t>(in, values);
    if (width == 2 && sizeof(T) > 2) return readAs<T, std::uint16_t>(in, values);
  }
  throw std::runtime_error(std::string(field) + " has elements of " + std::to_string(width) + " bytes");
}

}  // namespace packed

}  // namespace s2s::obs
