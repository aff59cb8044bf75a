#pragma once

#include "s2s/core/time.h"

namespace s2s::products {

/// GPS minus UTC in whole seconds at a time since 1980-01-06: 18 s from 2017-01-01 on. No leap second has been
/// announced since; should one come, `gps_time.cpp` gets a line.
int leapSeconds(core::TimeNs utc);

/// Adjusted standard GPS time of LAS: GPS seconds since 1980-01-06 less 1e9. Resolves 60 ns today.
double adjustedGpsTime_s(core::TimeNs utc);

}  // namespace s2s::products
