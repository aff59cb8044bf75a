#pragma once

#include <cmath>
#include <cstdint>

namespace s2s::calib::test {

/// A value in -1 .. 1 for each node of a lattice, the same every time.
inline double latticeValue(int x, int y) {
  auto bits = static_cast<std::uint32_t>(x) * 0x9E3779B1U ^ static_cast<std::uint32_t>(y) * 0x85EBCA77U;
  bits ^= bits >> 15U;
  bits *= 0x2C1B3C6DU;
  bits ^= bits >> 12U;
  bits *= 0x297A2D39U;
  bits ^= bits >> 15U;
  return static_cast<double>(bits) / 2147483648.0 - 1;
}

/// Texture of a bed: patches of about 12 cm that scatter more or less.
inline double textureAt(double x_m, double y_m) {
  const double u = x_m / 0.12, v = y_m / 0.12;
  const int i = static_cast<int>(std::floor(u)), j = static_cast<int>(std::floor(v));
  const double a = u - i, b = v - j;
  return (1 - a) * (1 - b) * latticeValue(i, j) + a * (1 - b) * latticeValue(i + 1, j) +
         (1 - a) * b * latticeValue(i, j + 1) + a * b * latticeValue(i + 1, j + 1);
}

}  // namespace s2s::calib::test
