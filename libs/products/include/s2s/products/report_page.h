#pragma once

#include <string>
#include <vector>

#include "s2s/products/run_summary.h"
#include "s2s/products/seabed_gridder.h"

namespace s2s::products {

/// A picture of the report.
struct ReportPicture {
  std::string title, caption;
  std::string mediaType;             ///< "image/png" or "image/jpeg"
  std::vector<unsigned char> bytes;  ///< encoded
};

struct ReportFile {
  std::string name;
  std::uint64_t bytes = 0;
};

/// What the report tells.
struct ReportContent {
  RunSummary summary;
  SeabedGridStatistics seabed;
  double gridCell_m = 0;
  std::vector<ReportPicture> pictures;
  std::vector<ReportFile> files;
};

/// One HTML page that needs nothing else: style and pictures stand inside it, no script, nothing from the net.
std::string reportPage(const ReportContent& content);

/// Base 64 of RFC 4648 with padding.
std::string toBase64(const std::vector<unsigned char>& bytes);

}  // namespace s2s::products
