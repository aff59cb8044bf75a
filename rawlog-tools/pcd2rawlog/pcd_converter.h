#pragma once

#include <string>
#include <vector>

#include "common/conversion_report.h"
#include "common/converter_options.h"

namespace s2s::tools::pcd {

/// The `.pcd` files of a folder, in natural order of their names ("scan2" before "scan10").
/// @throws core::InputError if the folder cannot be read or has none
std::vector<std::string> listPcdFiles(const std::string& folder);

/// Writes each file as a CObservationPointCloud with a CPointsMapXYZI (intensity 0 where the file has none). File i
/// gets the time start + i / rate, also when one before it cannot be used and is skipped.
/// @throws core::InputError if the folder has no usable file, core::OutputError
ConversionReport convertPcdFolder(const std::string& folder, double rate_hz, const ConverterOptions& options);

}  // namespace s2s::tools::pcd
