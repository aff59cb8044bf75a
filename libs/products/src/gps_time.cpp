#include "s2s/products/gps_time.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace s2s::products {

namespace {

constexpr std::int64_t kGpsEpoch_s = 315'964'800;         // 1980-01-06 00:00 UTC
constexpr std::int64_t kLasAdjustment_s = 1'000'000'000;  // ASPRS LAS 1.4, global encoding bit 0

// Unix times at which a second was added to UTC - GPS (IERS Bulletin C).
constexpr std::array<std::int64_t, 18> kLeaps_s = {
    362'793'600,   394'329'600,    // 1981-07, 1982-07
    425'865'600,   489'024'000,    // 1983-07, 1985-07
    567'993'600,   631'152'000,    // 1988-01, 1990-01
    662'688'000,   709'948'800,    // 1991-01, 1992-07
    741'484'800,   773'020'800,    // 1993-07, 1994-07
    820'454'400,   867'715'200,    // 1996-01, 1997-07
    915'148'800,   1'136'073'600,  // 1999-01, 2006-01
    1'230'768'000, 1'341'100'800,  // 2009-01, 2012-07
    1'435'708'800, 1'483'228'800   // 2015-07, 2017-01
};

}  // namespace

int leapSeconds(core::TimeNs utc) {
  return static_cast<int>(std::upper_bound(kLeaps_s.begin(), kLeaps_s.end(), utc / core::kNsPerSecond) -
                          kLeaps_s.begin());
}

double adjustedGpsTime_s(core::TimeNs utc) {
  const core::TimeNs shift = (leapSeconds(utc) - kGpsEpoch_s - kLasAdjustment_s) * core::kNsPerSecond;
  return static_cast<double>(utc + shift) / static_cast<double>(core::kNsPerSecond);
}

}  // namespace s2s::products
