#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace s2s::tools::pcd {

/// Unpacks a block in Marc Lehmann's LZF format, as `DATA binary_compressed` holds it.
///
/// A control byte below 32 stands before (control + 1) literal bytes. Otherwise its upper three bits are a length
/// (7: one more byte follows and is added), two more than which are copied from the output, at a distance of 1 plus
/// its lower five bits (high) and the next byte (low).
/// @return nothing if the block is damaged or does not unpack to exactly `size` bytes
std::optional<std::string> lzfDecompress(std::string_view packed, std::size_t size);

}  // namespace s2s::tools::pcd
