#include "s2s/sim/random.h"

#include <cmath>

namespace s2s::sim {

namespace {

std::uint64_t rotateLeft(std::uint64_t x, int k) { return (x << k) | (x >> (64 - k)); }

}  // namespace

std::uint64_t mixBits(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

Random::Random(std::uint64_t seed, std::uint64_t stream, std::uint64_t record) {
  std::uint64_t key = mixBits(mixBits(mixBits(seed) ^ stream) ^ record);
  for (auto& word : state_) word = key = mixBits(key);
}

std::uint64_t Random::bits() {
  const std::uint64_t result = rotateLeft(state_[0] + state_[3], 23) + state_[0];
  const std::uint64_t t = state_[1] << 17;
  state_[2] ^= state_[0];
  state_[3] ^= state_[1];
  state_[1] ^= state_[2];
  state_[0] ^= state_[3];
  state_[2] ^= t;
  state_[3] = rotateLeft(state_[3], 45);
  return result;
}

double Random::uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }

double Random::normal() {
  if (hasSpare_) {
    hasSpare_ = false;
    return spare_;
  }
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  const double angle = 2.0 * M_PI * uniform();
  spare_ = radius * std::sin(angle);
  hasSpare_ = true;
  return radius * std::cos(angle);
}

double Random::exponential() { return -std::log(1.0 - uniform()); }

double hashUniform(std::uint64_t key, std::int64_t i, std::int64_t j, std::int64_t k) {
  std::uint64_t h = mixBits(key ^ static_cast<std::uint64_t>(i));
  h = mixBits(h ^ static_cast<std::uint64_t>(j));
  h = mixBits(h ^ static_cast<std::uint64_t>(k));
  return static_cast<double>(h >> 11) * 0x1.0p-53;
}

}  // namespace s2s::sim
