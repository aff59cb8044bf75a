#include <cmath>
#include <cstring>

#include "s2s/sim/sonar_receiver.h"

namespace s2s::sim {

namespace {

/// 32-bit integer hash (the "lowbias32" constants of C. Wellons' search): full avalanche, vectorises.
inline std::uint32_t hash32(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  x ^= x >> 16;
  return x;
}

/// Natural logarithm of x in (0, 1], relative error below 2e-6: exponent and a polynomial on [sqrt(1/2), sqrt(2)).
inline float logApprox(float x) {
  std::int32_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  const std::int32_t exponent = (bits - 0x3f3504f3) >> 23;
  bits -= exponent * (1 << 23);
  float m;
  std::memcpy(&m, &bits, sizeof m);
  const float z = (m - 1.0f) / (m + 1.0f), z2 = z * z;  // ln m = 2 artanh z
  const float series = 2.0f * z * (1.0f + z2 * (0.33333333f + z2 * (0.2f + z2 * (0.14285714f + z2 * 0.11111111f))));
  return series + 0.69314718f * static_cast<float>(exponent);
}

/// sin(2 pi t) for t in [-1/4, 1/4], error below 1e-6 (Taylor to t^9).
inline float sineQuarter(float t) {
  const float a = 6.28318531f * t, a2 = a * a;
  return a * (1.0f + a2 * (-1.6666667e-1f + a2 * (8.3333333e-3f + a2 * (-1.9841270e-4f + a2 * 2.7557319e-6f))));
}

}  // namespace

__attribute__((target_clones("default", "avx2"))) void fillComplexNormals(std::uint64_t key, std::size_t count,
                                                                          float* re, float* im) {
  const auto k0 = static_cast<std::uint32_t>(key), k1 = static_cast<std::uint32_t>(key >> 32);
  const auto n = static_cast<std::uint32_t>(count);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t a = hash32((i ^ k0) + k1), b = hash32((i + 0x9e3779b9u) ^ hash32(a ^ k1));
    const float u = (static_cast<float>(static_cast<std::int32_t>(a >> 8)) + 0.5f) * 0x1.0p-24f;
    const float radius = std::sqrt(-2.0f * logApprox(u));
    // The angle's turn t in [-1/2, 1/2): sine and cosine are folded into the quarter turn around zero.
    const float t = static_cast<float>(static_cast<std::int32_t>(b >> 8)) * 0x1.0p-24f - 0.5f;
    const float folded = 0.25f - std::fabs(t);  // cos(2 pi t) = sin(2 pi (1/4 - |t|))
    const float mirrored = std::fabs(t) > 0.25f ? std::copysign(0.5f, t) - t : t;
    re[i] = radius * sineQuarter(folded);
    im[i] = radius * sineQuarter(mirrored);
  }
}

}  // namespace s2s::sim
