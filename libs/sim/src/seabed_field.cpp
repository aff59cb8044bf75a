#include "s2s/sim/seabed_field.h"

#include <cmath>

#include "s2s/sim/random.h"

namespace s2s::sim {

namespace {

double smoothStep(double u) { return u * u * (3 - 2 * u); }

/// Values in [-1, 1] at integer points, blended between them.
double valueNoise(std::uint64_t key, double x, double y) {
  const double fx = std::floor(x), fy = std::floor(y);
  const auto i = static_cast<std::int64_t>(fx), j = static_cast<std::int64_t>(fy);
  const double u = smoothStep(x - fx), v = smoothStep(y - fy);
  const auto corner = [&](int di, int dj) { return 2 * hashUniform(key, i + di, j + dj) - 1; };
  const double bottom = (1 - u) * corner(0, 0) + u * corner(1, 0);
  const double top = (1 - u) * corner(0, 1) + u * corner(1, 1);
  return (1 - v) * bottom + v * top;
}

}  // namespace

double fractalNoise(std::uint64_t key, double x, double y, int octaves) {
  // Blended value noise has a standard deviation of about 0.43, and the octaves' variances add.
  constexpr double kValueNoiseSigma = 0.43;
  double sum = 0, amplitude = 1, variance = 0;
  for (int octave = 0; octave < octaves; ++octave) {
    sum += amplitude * valueNoise(key + static_cast<std::uint64_t>(octave), x, y);
    variance += amplitude * amplitude;
    amplitude *= 0.5;
    x *= 2;
    y *= 2;
  }
  return sum / (kValueNoiseSigma * std::sqrt(variance));
}

double SeabedField::height_m(double x, double y) const {
  const SeabedOptions& o = options_;
  double h = o.height_m + o.slopeX * x + o.slopeY * y;
  const double across = y / o.channelHalfWidth_m;
  h -= o.channelDepth_m * std::exp(-0.5 * across * across);
  if (o.rippleHeight_m > 0) {
    const double along = x * std::cos(o.rippleDirection_rad) + y * std::sin(o.rippleDirection_rad);
    // Crests meander and fade, as those of real ripples do.
    const double phase = 2 * M_PI * along / o.rippleLength_m + 1.5 * fractalNoise(seed_ + 101, x / 6, y / 6, 2);
    const double strength = 0.5 + 0.5 * std::tanh(1.5 * fractalNoise(seed_ + 202, x / 15, y / 15, 2));
    h += 0.5 * o.rippleHeight_m * strength * std::sin(phase);
  }
  if (o.roughness_m > 0)
    h += o.roughness_m * fractalNoise(seed_ + 303, x / o.roughnessLength_m, y / o.roughnessLength_m, 4);
  for (const SeabedFeature& f : features_) {
    const double d = (Eigen::Vector2d(x, y) - f.center_m).squaredNorm() / (f.radius_m * f.radius_m);
    if (d < 40) h += f.height_m * std::exp(-0.5 * d);
  }
  return h;
}

}  // namespace s2s::sim
