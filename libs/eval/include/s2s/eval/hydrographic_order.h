#pragma once

#include <array>

namespace s2s::eval {

/// An order of IHO S-44 (Edition 6.1.0, table 1): the total vertical uncertainty allowed at 95 % confidence.
struct HydrographicOrder {
  const char* name;
  double a_m;  ///< part that does not depend on depth
  double b;    ///< part proportional to depth
};

constexpr std::array<HydrographicOrder, 3> kHydrographicOrders = {
    {{"Exclusive", 0.15, 0.0075}, {"Special", 0.25, 0.0075}, {"1a", 0.5, 0.013}}};

/// sqrt(a² + (b d)²) for a depth d >= 0 below the water surface; depths above it count as zero.
double totalVerticalUncertainty_m(const HydrographicOrder& order, double depth_m);

}  // namespace s2s::eval
