#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace s2s::tools::pcd {

/// The points of one PCD file.
struct PcdCloud {
  std::vector<float> x, y, z;
  std::vector<float> intensity;            ///< empty if the file has none
  std::vector<std::string> skippedFields;  ///< names of the fields that are not kept
  std::uint64_t notFinite = 0;             ///< points left out because a coordinate is NaN or infinite
  bool hasViewpoint = false;               ///< the file has a VIEWPOINT other than the identity; it is not applied
};

/// Reads x, y, z and, when there, `intensity` (or `i`, `reflectivity`) of an ASCII, binary or binary_compressed file.
/// @throws core::InputError if the file cannot be read, is damaged or has no x, y, z
PcdCloud readPcd(const std::string& path);

}  // namespace s2s::tools::pcd
