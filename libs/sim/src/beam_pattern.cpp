#include "s2s/sim/beam_pattern.h"

#include <cmath>

namespace s2s::sim {

namespace {

double sinc(double x) {
  const double a = M_PI * x;
  return std::abs(a) < 1e-6 ? 1 - a * a / 6 : std::sin(a) / a;
}

}  // namespace

double arrayPattern(double x, double taper) {
  return sinc(x) + 0.5 * (1 - taper) / taper * (sinc(x - 1) + sinc(x + 1));
}

double halfPowerPoint(double taper) {
  double low = 0, high = 1;  // the first null lies at 1 or beyond
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high), p = arrayPattern(middle, taper);
    (p * p > 0.5 ? low : high) = middle;
  }
  return low;
}

}  // namespace s2s::sim
