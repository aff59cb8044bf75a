#pragma once

#include <cstdint>

namespace s2s::sim {

/// Mixes 64 bits into 64 bits (the finaliser of SplitMix64): neighbouring inputs give unrelated outputs.
std::uint64_t mixBits(std::uint64_t x);

/// A stream of random numbers that depends on nothing but its key, so that the same seed gives the same bytes with
/// any number of threads: every record of every sensor has a stream of its own.
///
/// Generator: xoshiro256++ (Blackman & Vigna 2021), seeded by SplitMix64. The distributions are written here because
/// those of the standard library differ between compilers.
class Random {
 public:
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0, std::uint64_t record = 0);

  std::uint64_t bits();
  /// Uniform in [0, 1).
  double uniform();
  double uniform(double min, double max) { return min + (max - min) * uniform(); }
  /// Standard normal (Box-Muller).
  double normal();
  /// Exponential with mean 1.
  double exponential();

 private:
  std::uint64_t state_[4];
  double spare_ = 0;
  bool hasSpare_ = false;
};

/// A uniform number in [0, 1) that is a function of a key and up to three integers: randomness with a fixed place.
double hashUniform(std::uint64_t key, std::int64_t i, std::int64_t j = 0, std::int64_t k = 0);

}  // namespace s2s::sim
