#include <cmath>

#include "s2s/sim/random.h"
#include "s2s/sim/vessel_motion.h"

namespace s2s::sim {

namespace {

constexpr double kGravity_mps2 = 9.81;

/// Bretschneider's spectral density of elevation over angular frequency, m^2 s/rad (Fossen 2011, eq. 8.45 with the
/// significant height and the peak frequency as parameters).
double bretschneider(double omega, double significantHeight_m, double peakOmega) {
  const double ratio4 = std::pow(peakOmega / omega, 4);
  return 5.0 / 16.0 * significantHeight_m * significantHeight_m * ratio4 / omega * std::exp(-1.25 * ratio4);
}

/// Amplitude of a damped second-order system relative to its static answer.
double resonance(double omega, double naturalPeriod_s, double damping) {
  const double r = omega * naturalPeriod_s / (2 * M_PI);
  return 1 / std::sqrt((1 - r * r) * (1 - r * r) + 4 * damping * damping * r * r);
}

}  // namespace

WaveMotion::WaveMotion(const WaveOptions& o, std::uint64_t seed) {
  if (!o.enabled) return;
  Random random(seed, 0x77617665);
  const double peak = 2 * M_PI / o.peakPeriod_s, low = 0.6 * peak, high = 2.4 * peak;
  const double step = (high - low) / o.components;
  for (int i = 0; i < o.components; ++i) {
    const double omega = low + (i + random.uniform()) * step;
    const double amplitude = std::sqrt(2 * bretschneider(omega, o.significantHeight_m, peak) * step);
    const double slope = o.slopeResponse * amplitude * omega * omega / kGravity_mps2;  // deep water: k = omega^2 / g
    components_.push_back(
        {omega, random.uniform(0, 2 * M_PI), amplitude,
         slope * std::abs(std::sin(o.direction_rad)) * resonance(omega, o.rollNaturalPeriod_s, o.rollDamping),
         slope * std::abs(std::cos(o.direction_rad))});
  }
}

Jet WaveMotion::sum(double t_s, double Component::*amplitude, double shift_rad) const {
  Jet jet;
  for (const Component& c : components_) {
    const double a = c.*amplitude, w = c.frequency_radps;
    const double s = std::sin(w * t_s + c.phase_rad + shift_rad), k = std::cos(w * t_s + c.phase_rad + shift_rad);
    jet.value += a * s;
    jet.first += a * w * k;
    jet.second -= a * w * w * s;
  }
  return jet;
}

}  // namespace s2s::sim
