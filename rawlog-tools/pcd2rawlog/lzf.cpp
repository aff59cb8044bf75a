#include "pcd2rawlog/lzf.h"

#include <algorithm>

namespace s2s::tools::pcd {

std::optional<std::string> lzfDecompress(std::string_view packed, std::size_t size) {
  std::string out;
  out.reserve(std::min(size, 300 * packed.size()));  // no block unpacks to more than 264 / 3 times its size
  std::size_t at = 0;
  const auto byteAt = [&packed](std::size_t i) { return static_cast<std::uint8_t>(packed[i]); };
  while (at < packed.size()) {
    const std::size_t control = byteAt(at++);
    if (control < 32) {
      const std::size_t count = control + 1;
      if (at + count > packed.size() || out.size() + count > size) return std::nullopt;
      out.append(packed.substr(at, count));
      at += count;
      continue;
    }
    std::size_t length = control >> 5;
    if (at + (length == 7 ? 2 : 1) > packed.size()) return std::nullopt;
    if (length == 7) length += byteAt(at++);
    length += 2;
    const std::size_t distance = ((control & 0x1f) << 8) + byteAt(at++) + 1;
    if (distance > out.size() || out.size() + length > size) return std::nullopt;
    // Byte by byte: source and target overlap when a run is repeated.
    for (std::size_t i = 0; i < length; ++i) out.push_back(out[out.size() - distance]);
  }
  if (out.size() != size) return std::nullopt;
  return out;
}

}  // namespace s2s::tools::pcd
