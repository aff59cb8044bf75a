#pragma once

#include <optional>

#include "s2s/graph/gnss_guest.h"
#include "s2s/mapper/gnss_reader.h"
#include "s2s/products/run_summary.h"

namespace s2s::mapper {

/// What a run says about GNSS; nothing if there was none.
std::optional<products::GnssSummary> gnssSummary(const graph::GnssReport& report,
                                                 const std::optional<GeodeticPosition>& origin);

/// A sentence for the warnings if GNSS was distrusted; else empty.
std::string gnssWarning(const products::GnssSummary& summary);

}  // namespace s2s::mapper
